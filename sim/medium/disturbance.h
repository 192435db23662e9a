// Disturbances of the simulated FlexRay, as its medium sees them: at the sender, towards one receiver, and out
// of nothing. The nodes cannot observe them. All instants are true times. Those of the private CANs are in
// sim/medium/can_disturbance.h.
#pragma once

#include <cstddef>
#include <span>

#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "sim/medium/can_disturbance.h"

namespace ttf::sim::medium {

// A signal as it leaves a node; a disturbance may change it.
struct Leaving {
  NodeId sender{};
  schedules::model::Channel channel{};
  bus::ports::Signal signal{};
  TrueTime start{}, end{};
  std::span<const std::byte> bytes;  // may be pointed elsewhere; used before the call returns to the sender
  bool emitted = false;              // a fault sent it, no controller (FlexRayMedium::emit())
};

// The same signal on its last metre. With a guardian there are two: first to the coupler (receiver kNoNode), then
// from there to every receiver. The coupler decodes a marginal signal or not, and sends the result on afresh.
struct Arriving {
  NodeId sender{}, receiver{};
  schedules::model::Channel channel{};
  bus::ports::Signal signal{};
  TrueTime start{}, end{};
  bool regenerated = false;          // by the coupler: faults of the sender cannot make receivers disagree about it
  std::span<const std::byte> bytes;  // a frame's; they may be pointed elsewhere, as above
  bool emitted = false;              // as above, on either leg through a coupler
};

class Disturbance : public CanDisturbance {
 public:
  // Returns whether leaving() or arriving() may read or change the bytes, or change the channel, of the node's
  // present signal. If not, a transparent medium gives them no bytes.
  virtual bool touches(NodeId sender, schedules::model::Channel channel) const {
    return (void)sender, (void)channel, true;
  }
  // Changes a leaving signal. False: it does not leave.
  virtual bool leaving(Leaving& signal) { return (void)signal, true; }
  // Changes an arriving signal. False: it does not arrive. A frame can become undecodable or another frame
  // here; other signals cannot become frames. Nothing may be emitted from within: a signal is on its way only
  // after all its receivers have been asked.
  virtual bool arriving(Arriving& signal) { return (void)signal, true; }
  // Returns the instant of its next own act, after all nodes' events of that instant; act() does it.
  virtual TrueTime next() const { return kNever<TrueTime>; }
  virtual void act(TrueTime now) { (void)now; }
};

}  // namespace ttf::sim::medium
