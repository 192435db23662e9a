// Disturbances of the simulated private CANs, as their media see them: frames that their hosts do not hand over or do
// not get, bits seen inverted, a line that is held. The nodes cannot observe them. All instants are true times.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::sim::medium {

// A frame that begins, with the lowest identifier of those that do.
struct CanBeginning {
  std::size_t bus = 0;
  NodeId sender{};
  std::size_t bits = 0;                 // up to the end of its end of frame, stuff bits included
  std::optional<std::size_t> inverted;  // this bit is seen inverted; 0 is the start of frame
  std::span<const NodeId> seen_by;      // by these nodes only; empty: by all
};

class CanDisturbance {
 public:
  virtual ~CanDisturbance() = default;
  // Returns whether anything below may happen on the bus from now on and before `until`, or a controller goes off the
  // bus by CanMedium::hold_off(), or is released. If not, the medium need not look at single bits.
  virtual bool touches_can(std::size_t bus, TrueTime until) const { return (void)bus, (void)until, false; }
  // A host queues a frame. False: it is lost there.
  virtual bool queues_on_can(std::size_t bus, NodeId sender) { return (void)bus, (void)sender, true; }
  virtual void begins_on_can(CanBeginning& frame) { (void)frame; }
  // A receiver has accepted a frame. False: its host does not get it.
  virtual bool arrives_from_can(std::size_t bus, NodeId receiver) { return (void)bus, (void)receiver, true; }
  // Returns whether a receiver acknowledges.
  virtual bool acknowledges_on_can(std::size_t bus, NodeId node) { return (void)bus, (void)node, true; }
  // Returns until when the line is held dominant; an instant that is not after now: it is not held.
  virtual TrueTime holds_can(std::size_t bus) const { return (void)bus, TrueTime{}; }
};

}  // namespace ttf::sim::medium
