// An instant on all clocks of a node: the oscillator's microticks, local time, the cluster's global time where
// the node has it, and true time.
#pragma once

#include <cstdint>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::host {

// The clock of an ideal observer. In virtual time events happen when they are due, so the oscillator has true
// time; in real time they happen later.
class TrueClock {
 public:
  virtual ~TrueClock() = default;
  virtual TrueTime now() const = 0;
};

class NodeTime {
 public:
  // `true_clock` may be null: events then happen when they are due.
  NodeTime(NodeId node, const timebase::Oscillator& oscillator, const TrueClock* true_clock)
      : node_(node), oscillator_(oscillator), true_clock_(true_clock) {}

  // Sets the controller that keeps the cluster's clock. It outlives this.
  void follow(const bus::controller::FlexRayController& controller) { controller_ = &controller; }
  // Changes the oscillator's drift; its ticks so far stay the same.
  void drift(const timebase::Oscillator& oscillator) { oscillator_ = oscillator; }

  // Returns the node's clock of the cluster, or null while it has none: off FlexRay, or before it has integrated.
  const timebase::CycleClock* global() const { return controller_ ? controller_->synchronised_clock() : nullptr; }
  const timebase::Oscillator& oscillator() const { return oscillator_; }

  recording::records::Stamp stamp(Microticks at) const;
  // Converts to nominal microticks, rounded up.
  Microticks ticks(Duration duration) const {
    const std::int64_t period = oscillator_.nominal_period_ps();
    return {(duration.ns * 1000 + period - 1) / period};
  }

 private:
  NodeId node_;
  timebase::Oscillator oscillator_;
  const TrueClock* true_clock_;
  const bus::controller::FlexRayController* controller_ = nullptr;
};

}  // namespace ttf::nodes::host
