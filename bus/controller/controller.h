// A FlexRay communication controller starts the cluster or integrates into it, and keeps and corrects the
// node's synchronised clock. It sends the CNI's content in its own slots of both segments, and judges and
// stores frames that it receives.
//
// Protocol operation control (bus/poc/poc.h) decides its state: this class hands it events and carries out its
// actions. The engine or the runner drives it in its own microticks, so that the same controller runs in
// virtual and in real time:
//
//   while (running) { wait until controller.next_event() or a reception; advance() / receive(); }
//
//   L1  next_event() is never in the past of the last advance(), and advance(t) does everything due up to t
//   L2  receive() is called with the medium's order (flexray_port.h L3); a frame is judged at its end
//   L3  in its own static slots it always sends, a null frame if the CNI has no such fragment; in its dynamic slots
//       only what has not left yet; elsewhere never, and never against protocol operation control
//   L4  nothing here allocates after construction
//
// A valid frame decodes without error (FlexRay 2.1A, chapter 6). It lies within one slot. Its header has that slot's
// frame id and the present cycle count. A static frame has gPayloadLengthStatic words. A startup frame is a sync
// frame. A dynamic frame is no sync, startup or null frame. The schedule has no say. So a valid sync frame of any
// sender enters clock synchronisation and start-up. The host's schedule judges apart. A valid frame that it lacks is
// unexpected. It reaches no list.
//
// Interpretations where the sources leave room: a startup frame sent before normal operation is a null frame.
// A second communication element in a static slot is a syntax error of that slot, even after a valid frame.
// Activity that began outside every slot is reported under slot 0. Activity across slot boundaries violates
// the boundary of every slot that it touches (bus/controller/slot_board.h). Activity that outlasts the static
// segment is reported when the segment ends. It then violates the boundaries of the segment's last slot, and
// of the silent slots before it in which a frame is expected, back to the last activity received on the channel.
// The report replaces "no frame" there. A node alone with its own sync frame misses no term of clock
// correction. Cycle 0 of a leading coldstart node starts one macrotick after the end of its CAS.
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
#include "recording/records/enumerations.h"
#include "schedules/model/cluster.h"
#include "timebase/clock_sync.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::controller {

using recording::records::SlotStatus;
using enum recording::records::SlotStatus;

// The status of a slot as a host reads it, of one static slot on one channel in one cycle. No flag set: the channel
// was silent, as always in the node's own slots. Several may be set, for a valid frame with noise after it.
struct SlotSeen {
  bool valid_frame = false;
  bool syntax_error = false;
  bool content_error = false;
  bool boundary_violation = false;
  bool transmission_conflict = false;
  bool unexpected_frame = false;  // valid, but not as the schedule has it

  bool operator==(const SlotSeen&) const = default;
};

// The same status for the symbol window (E-Ray SWNIT). With several symbols, a valid media access test symbol
// and a syntax error are both set.
struct SymbolWindowSeen {
  bool valid_mts = false;
  bool syntax_error = false;           // anything else, and a second symbol
  bool boundary_violation = false;     // activity at the beginning or the end of the window
  bool transmission_conflict = false;  // with this node's own symbol

  bool operator==(const SymbolWindowSeen&) const = default;
};

// Status of clock synchronisation since the schedule began, under E-Ray's names (SPNU563A: registers SFS and CCEV).
struct SyncStatus {
  // Valid sync frames on channel A or B in the last even or odd cycle whose static segment is over. The node's
  // own count, too. At most 15, regardless of gSyncNodeMax.
  int VSAE = 0, VSAO = 0, VSBE = 0, VSBO = 0;
  // The last double cycle missed the offset or the rate term, or exceeded its limit.
  bool MOCS = false, MRCS = false, OCLR = false, RCLR = false;
  int vClockCorrectionFailed = 0;  // consecutive odd cycles that missed a term, up to kMaxClockCorrectionFailed

  bool operator==(const SyncStatus&) const = default;
};

// The events by which a controller informs its host. Called from advance(), receive() and the commands.
class ControllerEvents {
 public:
  virtual ~ControllerEvents() = default;
  virtual void cycle_started(std::int64_t cycle, Microticks at) { (void)cycle, (void)at; }
  // Slot 0: outside every slot.
  virtual void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, SlotStatus status,
                            Microticks at) {
    (void)cycle, (void)slot, (void)channel, (void)status, (void)at;
  }
  // The static segment of a cycle is over: its slot problems have been reported, and slot_status() describes
  // it. Also called during start-up, when the host must judge it by state().
  virtual void static_segment_ended(std::int64_t cycle, Microticks at) { (void)cycle, (void)at; }
  // Returns whether the host wants frame_received() and list_arrived() for every frame, also for a known one.
  virtual bool wants_receptions() const { return true; }
  // A valid frame in the slot that its header states, also an unexpected one; not during start-up. `frame` is valid
  // only during the call.
  virtual void frame_received(std::int64_t cycle, int slot, schedules::model::Channel channel,
                              const wire::DecodedFrame& frame, Microticks at) {
    (void)cycle, (void)slot, (void)channel, (void)frame, (void)at;
  }
  // Returns whether frame_sent() reads the bytes of transmissions.
  virtual bool wants_bytes() const { return true; }
  // A frame of an outgoing list left; `last` with the last fragment of that list.
  virtual void frame_sent(const ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                          std::uint32_t sequence, int fragment, bool last) {
    (void)transmission, (void)cycle, (void)null_frame, (void)pdu, (void)sequence, (void)fragment, (void)last;
  }
  // A fragment of list `sequence` arrived; `torn`: the incomplete list that it displaced.
  virtual void list_arrived(PduId pdu, cni::ArrivalEffect effect, std::uint32_t sequence,
                            std::optional<std::uint32_t> torn, Microticks at) {
    (void)pdu, (void)effect, (void)sequence, (void)torn, (void)at;
  }
  // The corrections computed from a double cycle, at the end of its odd cycle's static segment. Neither is in
  // force yet.
  virtual void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                               Microticks at) {
    (void)cycle, (void)offset, (void)rate, (void)at;
  }
  // A symbol left on one channel; in normal operation Signal::kCas is a media access test symbol.
  virtual void symbol_sent(ports::Signal signal, schedules::model::Channel channel, Microticks start, Microticks end) {
    (void)signal, (void)channel, (void)start, (void)end;
  }
  // Protocol operation control changed its state.
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
  // Starts in default config and stays idle until start_integrated() or start_cold().
  FlexRayController(const schedules::model::Cluster& cluster, NodeId node, ports::FlexRayPort& port,
                    ControllerEvents& events);
  ~FlexRayController();

  // Begins in normal active from cycle 0 on, as if start-up were over.
  void start_integrated(const InitialClock& clock);
  // Powers the controller on and gives its host's commands: configuration, RUN and, for a coldstart node,
  // ALLOW_COLDSTART. A running controller begins anew, without allocating, and keeps only its host's data:
  // lists, network management vector, external correction.
  void start_cold(Microticks now);
  // Executes a command of the host: kConfig to kFreeze of PocEventKind.
  void command(poc::PocEventKind command, Microticks now);

  // Returns an instant far in the future if only a reception can cause the next event.
  Microticks next_event() const;
  // Returns whether a reception may make the controller send before the present next_event().
  bool answers_at_once() const;
  void advance(Microticks now);
  void receive(const ports::Reception& reception);
  // Receives one frame on both channels at the same instants, as most frames arrive; `reception` says channel
  // A. The same as receive() for A, then for B. Returns whether next_event() or the state's kind has changed.
  // The test compares this, is_known() and receive_known() with receive() on drawn receptions
  // (tests/bus/controller/fast_ways_test.cc).
  bool receive_on_both(const ports::Reception& reception);
  // Returns whether `reception`, still on its way on both channels, will change only its slot's status and the
  // sync deviations. Nothing else may reach this node before it. True of null frames and of known fragments, that
  // is of most frames. Right after true, receive_known() may take the reception in before it arrives.
  bool is_known(const ports::Reception& reception);
  void receive_known(const ports::Reception& reception);

  // No value before a schedule has been derived or begun, and after it has been dropped.
  const std::optional<timebase::CycleClock>& clock() const { return clock_; }
  // Returns the clock if it is synchronised, else null.
  const timebase::CycleClock* synchronised_clock() const { return synchronised() ? &*clock_ : nullptr; }
  const poc::PocState& state() const { return poc_; }
  // Returns whether the clock is the cluster's, so that the host may rely on it.
  bool synchronised() const { return poc::in_operation(poc_.kind); }
  // Returns the status of a static slot (1..gNumberOfStaticSlots) in the static segment that ended last.
  // Activity that outlasts the segment has violated boundaries; its other errors are added when it ends.
  SlotSeen slot_status(int slot, schedules::model::Channel channel) const;
  SyncStatus sync_status() const;
  // Returns the status of the last finished symbol window; empty during start-up. The own symbol does not count.
  SymbolWindowSeen symbol_window_status(schedules::model::Channel channel) const;

  // Requests a media access test symbol in the next symbol window whose action point is ahead. It leaves on those
  // of the channels that this node is attached to. The state must be normal active with all slots (E-Ray SEND_MTS).
  // Returns false without effect in another state, while a symbol is pending, or without a symbol window.
  bool send_media_test_symbol(schedules::model::Channels channels = schedules::model::Channels::kAB);

  // Exactly gNetworkManagementVectorLength bytes (bus/controller/network_management.h).
  void set_network_management_vector(std::span<const std::byte> vector);
  std::span<const std::byte> network_management_vector() const;

  // Sets the external clock correction [uT], by which hosts make a cluster follow the time of another cluster
  // or of a standard. Until set anew, `offset` is added to the offset correction of every odd cycle whose
  // static segment has not ended yet. `rate` is added to the rate correction computed then. Both apply in
  // normal operation only. Positive values lengthen the cycle. pExternOffsetCorrection and
  // pExternRateCorrection limit the magnitudes; the sums are not checked against pOffsetCorrectionOut and
  // pRateCorrectionOut (SPNU563A 26.2.4.5). All nodes need the same values in the same double cycle.
  // Interpretation: the next rate correction goes on from the rate in force, including the external term. So a
  // term given once stays, and a repeated one adds up, less damping.
  void set_external_correction(int offset, int rate);
  cni::OutgoingList& outgoing(PduId pdu);  // must be a PDU that this node sends
  cni::IncomingList& incoming(PduId pdu);  // any other PDU on FlexRay

 private:
  struct State;
  std::unique_ptr<State> state_;
  // Parts of the state that simulations read often.
  const poc::PocState& poc_;
  const std::optional<timebase::CycleClock>& clock_;
};

}  // namespace ttf::bus::controller
