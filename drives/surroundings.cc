#include "drives/surroundings.h"

#include "drives/drive.h"
#include "drives/step_catalog.h"
#include "nodes/sensing/recorded.h"
#include "nodes/sensing/traced.h"

namespace ttf::drives {

Surroundings surroundings_of(const Scenario& scenario, const schedules::model::Cluster& cluster, std::uint64_t seed,
                             std::uint32_t replication,
                             const std::shared_ptr<const recording::rows::RecordedInput>& recorded) {
  const TrueTime start = drive_start(cluster);
  Surroundings around;
  if (is_recorded(cluster)) {
    around.scene = std::make_shared<nodes::sensing::RecordedScene>(*recorded, start);
    return around;
  }
  if (scenario.truth) {
    around.scene = std::make_shared<nodes::sensing::TracedScene>(scenario.truth, start);
    return around;
  }
  around.world = std::make_shared<nodes::sensing::WorldScene>(scenario.world, seed, replication, start);
  around.scene = around.world;
  for (const sim::world::ObjectConfig& object : scenario.world.objects)
    if (object.reference && !around.reference)
      around.reference.emplace(scenario.reference, scenario.world, seed, replication);
  return around;
}

void Surroundings::show(Observer& observer, const Scenario& scenario, const schedules::model::Cluster& cluster) const {
  if (reference) observer.follow(*reference, world->world(), drive_start(cluster), !scenario.startup.cold);
}

}  // namespace ttf::drives
