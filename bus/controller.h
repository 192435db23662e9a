// A FlexRay communication controller in normal active state: it keeps the node's synchronised clock, sends what is in the
// CNI in its own static slots, judges and stores what it receives, and corrects its clock.
//
// Driven from outside in its own microticks, so that the same controller runs in virtual and in real time:
//
//   while (running) { wait until controller.next_event() or a reception; advance() / receive(); }
//
//   L1  next_event() is never in the past of the last advance(), and advance(t) does everything due up to t
//   L2  receive() is called with the medium's order (flexray_port.h L3); a frame is judged at its end
//   L3  in a slot it owns it always sends (a null frame where the CNI has no such fragment), elsewhere never
//   L4  nothing here allocates after construction
//
// Start-up, wake-up, error states and the dynamic segment are not part of this class: nodes begin as if integrated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bus/flexray_port.h"
#include "bus/list_buffer.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/cluster.h"
#include "timebase/clock_sync.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus {

// Per slot and channel, what was seen (FlexRay 2.1A vSS). Values are the bits of records::SlotProblem.
enum SlotStatus : std::uint8_t {
  kValidFrame = 0,
  kSyntaxError = 1,
  kContentError = 2,
  kBoundaryViolation = 4,
  kTransmissionConflict = 8,
  kNoFrame = 16,
};

// What the controller tells its host. Called from advance() and receive().
class ControllerEvents {
 public:
  virtual ~ControllerEvents() = default;
  virtual void slot_problem(std::int64_t cycle, int slot, schedules::Channel channel, SlotStatus status, Microticks at) {
    (void)cycle, (void)slot, (void)channel, (void)status, (void)at;
  }
  // A frame of an outgoing list left; `last` with the last fragment of that list.
  virtual void frame_sent(const Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                          std::uint32_t sequence, int fragment, bool last) {
    (void)transmission, (void)cycle, (void)null_frame, (void)pdu, (void)sequence, (void)fragment, (void)last;
  }
  // A fragment of list `sequence`; `torn`: the list it displaced before that was complete.
  virtual void list_arrived(PduId pdu, ArrivalEffect effect, std::uint32_t sequence, std::optional<std::uint32_t> torn,
                            Microticks at) {
    (void)pdu, (void)effect, (void)sequence, (void)torn, (void)at;
  }
  // The corrections as computed from a double cycle: at the end of its odd cycle's static segment, before either is in force.
  virtual void clock_corrected(std::int64_t cycle, const timebase::Correction& offset,
                               const timebase::Correction& rate, Microticks at) {
    (void)cycle, (void)offset, (void)rate, (void)at;
  }
};

struct InitialClock {
  Microticks cycle_start{};   // of cycle 0
  int rate = 0;               // [uT per cycle]
};

class FlexRayController {
 public:
  FlexRayController(const schedules::Cluster& cluster, NodeId node, InitialClock clock, FlexRayPort& port,
                    ControllerEvents& events);
  ~FlexRayController();

  Microticks next_event() const;
  void advance(Microticks now);
  void receive(const Reception& reception);

  const timebase::CycleClock& clock() const { return clock_; }
  OutgoingList& outgoing(PduId pdu);            // must be a PDU this node sends
  IncomingList& incoming(PduId pdu);            // any other PDU on FlexRay

 private:
  struct State;
  void send_slot(Microticks at);
  void close_static_segment(Microticks at);
  timebase::CycleClock clock_;
  std::unique_ptr<State> state_;
};

}  // namespace ttf::bus
