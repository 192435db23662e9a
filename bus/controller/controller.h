// A FlexRay communication controller: it starts the cluster or integrates into it, keeps the node's synchronised clock,
// sends what is in the CNI in its own slots of both segments, judges and stores what it receives, and corrects its
// clock.
//
// Why it is in its state is protocol operation control's business (bus/poc/poc.h); this class gives that its events,
// and does what it says. Driven from outside in its own microticks, so that the same controller runs in virtual and in
// real time:
//
//   while (running) { wait until controller.next_event() or a reception; advance() / receive(); }
//
//   L1  next_event() is never in the past of the last advance(), and advance(t) does everything due up to t
//   L2  receive() is called with the medium's order (flexray_port.h L3); a frame is judged at its end
//   L3  in a static slot it owns it always sends (a null frame where the CNI has no such fragment), in a dynamic slot
//       what has not left yet, elsewhere never; and never anything that protocol operation control does not allow
//   L4  nothing here allocates after construction
//
// Readings taken where the sources leave room: a startup frame sent before normal operation is a null frame. A second
// communication element in a static slot is a syntax error of that slot, also where the first was a valid frame. What
// began outside every slot is reported under slot 0. What crosses slots' boundaries violates those of every slot it
// touches (bus/controller/slot_board.h); of what goes on when the static segment ends, that is said then of the
// segment's last slot, and of the empty slots in front of it behind all that was heard on the channel, instead of "no
// frame". A node alone with its own sync frame misses no term of clock correction. Cycle 0 of a leading coldstart node
// starts one macrotick after the end of its CAS.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "bus/cni/cni.h"
#include "bus/poc/poc.h"
#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "timebase/clock_sync.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::controller {

// Per slot and channel, what was seen (FlexRay 2.1A vSS). Values are the bits of records::SlotProblem.
enum SlotStatus : std::uint8_t {
  kValidFrame = 0,
  kSyntaxError = 1,
  kContentError = 2,
  kBoundaryViolation = 4,
  kTransmissionConflict = 8,
  kNoFrame = 16,
};

// The same as a host reads it back, of one static slot on one channel in one cycle. Nothing set: nothing was heard,
// which is so in the node's own slots, too. More than one may be set: a valid frame and noise behind it.
struct SlotSeen {
  bool valid_frame = false;
  bool syntax_error = false;
  bool content_error = false;
  bool boundary_violation = false;
  bool transmission_conflict = false;

  bool operator==(const SlotSeen&) const = default;
};

// The same of the symbol window (E-Ray SWNIT). A media access test symbol that is one of several is valid, and a syntax
// error besides.
struct SymbolWindowSeen {
  bool valid_mts = false;
  bool syntax_error = false;           // anything else, and a second symbol
  bool boundary_violation = false;     // something was on the channel where the window begins or ends
  bool transmission_conflict = false;  // with this node's own symbol

  bool operator==(const SymbolWindowSeen&) const = default;
};

// What clock synchronisation has had to go by since the schedule began, under E-Ray's names (SPNU563A: registers SFS
// and CCEV).
struct SyncStatus {
  // Valid sync frames on channel A or B in the last even or odd cycle whose static segment is over, the node's own
  // included; counted up to 15, whatever gSyncNodeMax says.
  int VSAE = 0, VSAO = 0, VSBE = 0, VSBO = 0;
  // Of the last double cycle: the offset or the rate term was missing, or was beyond its limit.
  bool MOCS = false, MRCS = false, OCLR = false, RCLR = false;
  int vClockCorrectionFailed = 0;  // odd cycles in a row in which a term was missing, up to kMaxClockCorrectionFailed

  bool operator==(const SyncStatus&) const = default;
};

// What the controller tells its host. Called from advance(), receive() and the commands.
class ControllerEvents {
 public:
  virtual ~ControllerEvents() = default;
  virtual void cycle_started(std::int64_t cycle, Microticks at) { (void)cycle, (void)at; }
  // slot 0: outside every slot.
  virtual void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, SlotStatus status,
                            Microticks at) {
    (void)cycle, (void)slot, (void)channel, (void)status, (void)at;
  }
  // The static segment of a cycle is over, its slot problems have been told, and slot_status() is of it. During
  // start-up too: what that is worth is the host's to judge by state().
  virtual void static_segment_ended(std::int64_t cycle, Microticks at) { (void)cycle, (void)at; }
  // Whether it has to be told of every frame received, and of every fragment that is known already.
  virtual bool wants_receptions() const { return true; }
  // A valid frame in the slot it says it is of; not during start-up. `frame` only during the call.
  virtual void frame_received(std::int64_t cycle, int slot, schedules::model::Channel channel,
                              const wire::DecodedFrame& frame, Microticks at) {
    (void)cycle, (void)slot, (void)channel, (void)frame, (void)at;
  }
  // Whether frame_sent() looks at the bytes of transmissions.
  virtual bool wants_bytes() const { return true; }
  // A frame of an outgoing list left; `last` with the last fragment of that list.
  virtual void frame_sent(const ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                          std::uint32_t sequence, int fragment, bool last) {
    (void)transmission, (void)cycle, (void)null_frame, (void)pdu, (void)sequence, (void)fragment, (void)last;
  }
  // A fragment of list `sequence`; `torn`: the list it displaced before that was complete.
  virtual void list_arrived(PduId pdu, cni::ArrivalEffect effect, std::uint32_t sequence,
                            std::optional<std::uint32_t> torn, Microticks at) {
    (void)pdu, (void)effect, (void)sequence, (void)torn, (void)at;
  }
  // The corrections as computed from a double cycle: at the end of its odd cycle's static segment, before either is in
  // force.
  virtual void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                               Microticks at) {
    (void)cycle, (void)offset, (void)rate, (void)at;
  }
  // A symbol left, on one channel; within normal operation Signal::kCas is a media access test symbol.
  virtual void symbol_sent(ports::Signal signal, schedules::model::Channel channel, Microticks start, Microticks end) {
    (void)signal, (void)channel, (void)start, (void)end;
  }
  // Protocol operation control went from one state to another.
  virtual void state_changed(poc::PocKind from, const poc::PocStep& step, Microticks at) {
    (void)from, (void)step, (void)at;
  }
};

struct InitialClock {
  Microticks cycle_start{};  // of cycle 0
  int rate = 0;              // [uT per cycle]
};

class FlexRayController {
 public:
  // In default config; nothing happens until one of the two below.
  FlexRayController(const schedules::model::Cluster& cluster, NodeId node, ports::FlexRayPort& port,
                    ControllerEvents& events);
  ~FlexRayController();

  // As if start-up were over: normal active from cycle 0 on.
  void start_integrated(const InitialClock& clock);
  // Power-on, and what a host commands then: configuration, RUN and, for a coldstart node, ALLOW_COLDSTART. Also of a
  // controller at work, which begins anew, without allocating: what its host has given it is all that is left (its
  // lists, its network management vector, its external correction).
  void start_cold(Microticks now);
  // A command of the host: kConfig to kFreeze of PocEventKind.
  void command(poc::PocEventKind command, Microticks now);

  // Far in the future where nothing is due without a reception.
  Microticks next_event() const;
  // Whether a reception may make it send something before next_event(), as that is now.
  bool answers_at_once() const;
  void advance(Microticks now);
  void receive(const ports::Reception& reception);
  // The same on both channels at the same instants, as most of what nodes send arrives: receive() of channel A, which
  // `reception` says, and of channel B. Whether that has changed next_event() or the state's kind.
  bool receive_on_both(const ports::Reception& reception);
  // What is on its way to this node on both channels, and nothing else until it is there: whether it changes nothing
  // but what was seen of its slot and the sync deviations. So do null frames and fragments of lists that are there, and
  // most frames are either. Then, right after this, hear_known() may take it in before it is there.
  bool knows(const ports::Reception& reception);
  void hear_known(const ports::Reception& reception);

  // Nothing before a schedule has been derived or begun, and after it has been dropped.
  const std::optional<timebase::CycleClock>& clock() const { return clock_; }
  // The same where the host may rely on it, else null.
  const timebase::CycleClock* synchronised_clock() const { return synchronised() ? &*clock_ : nullptr; }
  const poc::PocState& state() const { return poc_; }
  // Whether the clock is the cluster's, which the host may rely on.
  bool synchronised() const { return in_operation(poc_.kind); }
  // What was seen in a static slot (1..gNumberOfStaticSlots) of the cycle whose static segment ended last, until the
  // next one ends. What outlasts the segment has violated boundaries; the rest is added when it is over.
  SlotSeen slot_status(int slot, schedules::model::Channel channel) const;
  SyncStatus sync_status() const;
  // Of the last symbol window that is over; nothing during start-up. Nothing is heard of the own symbol.
  SymbolWindowSeen symbol_window_status(schedules::model::Channel channel) const;

  // A media access test symbol in the next symbol window whose action point is ahead, on those of the channels that
  // this node is attached to. False, and nothing is sent: not in normal active with all slots (E-Ray SEND_MTS), one is
  // pending, or the cycle has no symbol window.
  bool send_media_test_symbol(schedules::model::Channels channels = schedules::model::Channels::kAB);

  // bus/controller/network_management.h. Exactly gNetworkManagementVectorLength bytes.
  void set_network_management_vector(std::span<const std::byte> vector);
  std::span<const std::byte> network_management_vector() const;

  // External clock correction [uT], by which hosts make a cluster follow another one's time or that of a standard:
  // added to the offset correction of every odd cycle whose static segment has not ended yet, and to the rate
  // correction that is computed then, until set anew; only in normal operation. Positive lengthens the cycle. The
  // magnitudes end at pExternOffsetCorrection and pExternRateCorrection; the sum is not checked against
  // pOffsetCorrectionOut and pRateCorrectionOut (SPNU563A 26.2.4.5). All nodes have to be given the same in the same
  // double cycle. Reading taken: the rate in force, which the next correction goes on from, is the one with the
  // external term in it, so that a term given once stays and one given again adds up, less damping.
  void set_external_correction(int offset, int rate);
  cni::OutgoingList& outgoing(PduId pdu);  // must be a PDU this node sends
  cni::IncomingList& incoming(PduId pdu);  // any other PDU on FlexRay

 private:
  struct State;
  std::unique_ptr<State> state_;
  // In it; simulations ask for little else, and often.
  const poc::PocState& poc_;
  const std::optional<timebase::CycleClock>& clock_;
};

}  // namespace ttf::bus::controller
