// What a cluster drives through, and the reference beside it: the same for whoever simulates, whoever runs one node of
// it in real time, and whoever adds the truth afterwards.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "drives/scenario.h"
#include "nodes/sensing/scene.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "drives/observer.h"
#include "sim/world/reference.h"

namespace ttf::sim {

struct Surroundings {
  std::shared_ptr<const nodes::Scene> scene;
  std::shared_ptr<const nodes::WorldScene> world;  // the same, unless it is recorded
  std::optional<world::Reference> reference;       // in a world, of the first object that has one

  // Has the observer look at the reference, too. This must outlive it.
  void show(Observer& observer, const nodes::Scenario& scenario, const schedules::Cluster& cluster) const;
};

// `recorded`: null where the cluster takes none.
Surroundings surroundings_of(const nodes::Scenario& scenario, const schedules::Cluster& cluster, std::uint64_t seed,
                             std::uint32_t replication,
                             const std::shared_ptr<const recording::RecordedInput>& recorded);

}  // namespace ttf::sim
