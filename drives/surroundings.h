// What a cluster drives through, and the reference beside it: the same for whoever simulates, whoever runs one node of
// it in real time, and whoever adds the truth afterwards.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "drives/observer.h"
#include "drives/scenario.h"
#include "nodes/sensing/scene.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sim/world/reference.h"

namespace ttf::drives {

struct Surroundings {
  std::shared_ptr<const nodes::sensing::Scene> scene;
  std::shared_ptr<const nodes::sensing::WorldScene> world;  // the same, unless it is recorded
  std::optional<sim::world::Reference> reference;           // in a world, of the first object that has one

  // Has the observer look at the reference, too. This must outlive it.
  void show(Observer& observer, const Scenario& scenario, const schedules::model::Cluster& cluster) const;
};

// `recorded`: null where the cluster takes none.
Surroundings surroundings_of(const Scenario& scenario, const schedules::model::Cluster& cluster, std::uint64_t seed,
                             std::uint32_t replication,
                             const std::shared_ptr<const recording::rows::RecordedInput>& recorded);

}  // namespace ttf::drives
