// The world of another simulator as the scene: a truth trace (recording/osi/truth_trace.h).
//
// Between two messages an object moves along the cubic Hermite polynomial of its positions and velocities. Velocity,
// acceleration and yaw rate go in a straight line, and the heading goes the shorter way round. An object that is in one
// message and not in the next leaves the scene right behind the first. Before the first message and after the last the
// scene stands still.
//
// The host vehicle carries the sensors; without one the ground's axes are those of the sensors. States of objects are
// in the vehicle's axes, with speed, acceleration and yaw rate over ground.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "recording/osi/truth_trace.h"
#include "sensors/scene.h"

namespace ttf::sensors {

class TracedScene final : public Scene {
 public:
  // `start` is the true time of the first message.
  TracedScene(std::shared_ptr<const recording::osi::TruthTrace> trace, TrueTime start);
  // An object's number is its place in TruthTrace::objects.
  void states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const override;
  sim::world::EgoState ego_at(TrueTime at) const override;
  std::size_t objects() const override { return trace_->objects.size(); }

 private:
  // An instant between two messages.
  struct Between {
    std::size_t message = 0;  // the one before
    double part = 0.0;        // 0 at that message, 1 at the next
    double gap = 0.0;         // between the two [s]
  };
  Between between(TrueTime at) const;
  std::optional<recording::osi::TracedState> state_of(const recording::osi::TracedObject& object,
                                                      const Between& at) const;
  sim::world::EgoState ego_at(const Between& at) const;

  std::shared_ptr<const recording::osi::TruthTrace> trace_;
  TrueTime start_;
};

}  // namespace ttf::sensors
