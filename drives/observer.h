// Adds what nobody in the cluster knows to the records of a drive: the truth, whenever a sensor measures and whenever
// the feature service uses an image; a fix of the reference, when the fusion node first could have it.
//
// The truth says on whose clock it was when (records::TruthState): nodes that measure at one instant each record it,
// once.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "nodes/sensing/scene.h"
#include "recording/records/records.h"
#include "sim/world/reference.h"
#include "sim/world/world.h"

namespace ttf::sim {

class Observer final : public records::Sink {
 public:
  // Listens to the records of a run; `out` gets what it adds, between them. Both must outlive it.
  Observer(const nodes::Scene& scene, std::size_t nodes, records::Sink& out);

  // `start`: of the world, which the reference is in. `integrated`: cycle 0 starts at kFirstCycle.
  void follow(const world::Reference& reference, const world::World& world, TrueTime start, bool integrated);

  bool wants_frames() const override { return false; }
  using records::Sink::on;
  void on(const records::Measured& measured) override { truth(measured.stamp); }
  void on(const records::FeatureUsed& used) override { truth(used.stamp); }
  void on(const records::FusionStep& step) override;

 private:
  GlobalTime global_of(TrueTime at, const records::Stamp& fused) const;
  void truth(const records::Stamp& stamp);

  const nodes::Scene& scene_;
  records::Sink& out_;
  const world::Reference* reference_ = nullptr;
  const world::World* world_ = nullptr;
  TrueTime start_{};
  bool integrated_ = true;
  std::uint32_t next_fix_ = 0;
  std::vector<world::ObjectState> states_;
  std::vector<std::optional<TrueTime>> last_truth_;  // by NodeId
};

}  // namespace ttf::sim
