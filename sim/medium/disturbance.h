// What may go wrong on the simulated FlexRay, seen from the medium: at the sender, towards one receiver, and out of
// nothing. The nodes know nothing of it. All instants are true times.
#pragma once

#include <cstddef>
#include <span>

#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"

namespace ttf::sim::medium {

// A signal as it leaves a node, to be changed.
struct Leaving {
  NodeId sender{};
  schedules::model::Channel channel{};
  bus::ports::Signal signal{};
  TrueTime start{}, end{};
  std::span<const std::byte> bytes;  // may be pointed elsewhere; used before the call returns to the sender
  bool emitted = false;              // no controller sent it, but a fault (FlexRayMedium::emit())
};

// The same on its last metre. Through a guardian it has two: first to the coupler (receiver kNoNode), then from there
// to every receiver; what was marginal about the signal, the coupler has made out one way or the other and sent on
// afresh.
struct Arriving {
  NodeId sender{}, receiver{};
  schedules::model::Channel channel{};
  bus::ports::Signal signal{};
  TrueTime start{}, end{};
  bool regenerated = false;          // by the coupler: no fault of the sender can make receivers disagree about it
  std::span<const std::byte> bytes;  // of a frame: may be pointed elsewhere, as above
  bool emitted = false;              // as above, on either leg through a coupler
};

class Disturbance {
 public:
  virtual ~Disturbance() = default;
  // Whether leaving() or arriving() may look at the bytes, or change bytes or channel, of what the node sends now.
  // Where a medium is transparent and this says no, they get no bytes.
  virtual bool touches(NodeId sender, schedules::model::Channel channel) const {
    return (void)sender, (void)channel, true;
  }
  // False: it does not leave.
  virtual bool leaving(Leaving& signal) { return (void)signal, true; }
  // False: it does not arrive. A frame can be made undecodable or another frame here; nothing else can become a frame.
  // Nothing may be emitted from within: the signal is not on its way before all its receivers have been asked.
  virtual bool arriving(Arriving& signal) { return (void)signal, true; }
  // When it acts by itself next, after all nodes' events of that instant; and what it does then.
  virtual TrueTime next() const { return kNever<TrueTime>; }
  virtual void act(TrueTime now) { (void)now; }
};

}  // namespace ttf::sim::medium
