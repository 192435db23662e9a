#include "sim/drives/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "nodes/fusion/fusion_host.h"
#include "sensors/recorded/recorded.h"
#include "sensors/traced.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

constexpr double kMoving_mps = 0.1;

bool moves(const sim::world::vehicle::EgoConfig& ego) {
  return ego.actuator.has_value() || ego.speed > kMoving_mps ||
         std::ranges::any_of(ego.segments, [](const auto& segment) {
           return segment.pace.acceleration.value_or(0.0) > 0.0 || segment.pace.speed.value_or(0.0) > kMoving_mps;
         });
}

bool moves(const recording::osi::TracedObject& vehicle) {
  return std::ranges::any_of(vehicle.lives.front().states,
                             [](const auto& state) { return std::hypot(state.vx, state.vy) > kMoving_mps; });
}

}  // namespace

Surroundings surroundings_of(const Scenario& scenario, const schedules::model::Cluster& cluster, std::uint64_t seed,
                             std::uint32_t replication,
                             const std::shared_ptr<const recording::rows::RecordedInput>& recorded) {
  const TrueTime start = drive_start(cluster);
  Surroundings around;
  if (sensors::recorded::is_recorded(cluster)) {
    around.scene = std::make_shared<sensors::recorded::RecordedScene>(*recorded, start);
    return around;
  }
  if (scenario.truth) {
    around.scene = std::make_shared<sensors::TracedScene>(scenario.truth, start);
    return around;
  }
  sim::world::WorldConfig world = scenario.world;
  if (world.ego && world.ego->actuator) world.ego->actuator->between = between_readings(cluster);
  around.world = std::make_shared<sensors::WorldScene>(world, seed, replication, start);
  around.scene = around.world;
  for (const sim::world::ObjectConfig& object : scenario.world.objects)
    if (object.reference && !around.reference)
      around.reference.emplace(scenario.reference, scenario.world, seed, replication);
  return around;
}

void Surroundings::show(Observer& observer, const Scenario& scenario, const schedules::model::Cluster& cluster) const {
  if (reference) observer.follow(*reference, world->world(), drive_start(cluster), !scenario.startup.cold);
  // The field of a recorded sensor is unknown, and so is that of a cluster without sensors.
  if (sensors::recorded::is_recorded(cluster)) return;
  if (std::vector<sensors::SensorView> views = sensors::kinds::views_of(scenario.sensors, cluster); !views.empty())
    observer.watch(std::move(views));
}

std::string motion_warning(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  if (sensors::recorded::is_recorded(cluster) || nodes::fusion::fused_odometry(cluster) != kNoSensor) return "";
  const std::string without = fmt::format(
      "moves, and {} has no odometry that its fusion reads: its tracks have velocities relative to the vehicle, "
      "and the truth has them over ground",
      cluster.file);
  if (scenario.truth) {
    if (!scenario.truth->host || !moves(scenario.truth->host->vehicle)) return "";
    return fmt::format("{}: vehicle {} {}", scenario.truth->name, scenario.truth->host->vehicle.id, without);
  }
  if (!scenario.world.ego || !moves(*scenario.world.ego)) return "";
  Findings none;
  const int line = StrictYaml::parse(scenario.text, scenario.file).root(none).map("world").line("ego");
  return Finding{scenario.file, line, "world.ego", "", without}.sentence();
}

}  // namespace ttf::sim::drives
