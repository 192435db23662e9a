// Adds records that no node can make. The truth is recorded whenever a sensor measures, the feature service uses an image, or an
// actuator reads commands. The state of the sensors' vehicle goes with it, unless the vehicle stands at the origin. A fix of the
// reference is recorded when the fusion node first could have it.
//
// A truth record names the node and clock that set its instant (records::TruthState). Nodes that measure at one
// instant each record it once.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "sensors/in_view.h"
#include "sensors/scene.h"
#include "sim/world/reference.h"
#include "sim/world/world.h"

namespace ttf::sim::drives {

class Observer final : public recording::records::Sink {
 public:
  // Listens to the records of a drive, and adds its own to `out` between them. Both must outlive the observer.
  Observer(const sensors::Scene& scene, std::size_t nodes, recording::records::Sink& out);

  // `start` is that of the world, which contains the reference. `integrated`: cycle 0 starts at kFirstCycle.
  void follow(const sim::world::Reference& reference, const sim::world::World& world, TrueTime start, bool integrated);

  // Judges which objects these sensors have in view. Otherwise all are.
  void watch(std::vector<sensors::SensorView> sensors);

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::Measured& measured) override { truth(measured.stamp); }
  void on(const recording::records::FeatureUsed& used) override { truth(used.stamp); }
  void on(const recording::records::CommandTaken& taken) override { truth(taken.stamp); }
  void on(const recording::records::FusionStep& step) override;

 private:
  GlobalTime global_of(TrueTime at, const recording::records::Stamp& fused) const;
  void truth(const recording::records::Stamp& stamp);

  const sensors::Scene& scene_;
  recording::records::Sink& out_;
  const sim::world::Reference* reference_ = nullptr;
  const sim::world::World* world_ = nullptr;
  TrueTime start_{};
  bool integrated_ = true;
  std::uint32_t next_fix_ = 0;
  std::vector<sim::world::ObjectState> states_;
  std::optional<sensors::InView> in_view_;
  std::vector<std::optional<TrueTime>> last_truth_;  // by NodeId
};

}  // namespace ttf::sim::drives
