// Checks of drives whose commands drive the vehicle.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "faults/plan.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using schedules::model::Cluster;
using schedules::model::Task;

// The vehicle has room for actuations of readings by time (sim/world/vehicle/driven.h). Lists that activate a task may
// come in any number, if a node babbles.
constexpr Duration kLeastBetween = Duration::milliseconds(2);

bool is_by_time(const Task& task) { return task.activation.kind == schedules::model::ActivationKind::kTime; }
Duration period_by_time(const Cluster& cluster, const Task& task) {
  return task.activation.at.repetition * cluster.cycle();
}

// An oscillator counts a task's time: one that is slow by a share d counts 1 / (1 - d) of it. A sixteenth more is enough up to
// 1/17, which no fault exceeds.
Duration longest_in_true_time(const Task& task) {
  static_assert(ttf::faults::kMostDriftPpb <= 1'000'000'000 / 17);
  return task.worst_case + Duration{task.worst_case.ns / 16 + 1};
}

// The actuator distinguishes a command from one a round later up to this age (past_time_stamp() of nodes/host/step.h).
Duration oldest_distinct(const Cluster& cluster) { return Duration{cluster.round().ns / 8 * 7}; }

}  // namespace

void check_loop(const Scenario& scenario, const Cluster& cluster) {
  const std::vector<PlacedTask> found = tasks_with(cluster, StepRole::kActuator);
  const bool driven = scenario.world.ego && scenario.world.ego->actuator;
  if (found.empty() && !driven) return;
  const std::string key = "world.ego.actuator";
  if (!driven)
    throw InputError(cluster.finding(found.front().task->line, found.front().path() + ".step", "actuator",
                                     fmt::format("needs a vehicle that it drives: {} has no {}", scenario.file, key)));
  const int line = scenario.world.ego->actuator_line;
  if (found.empty())
    throw InputError({scenario.file, line, key, "",
                      fmt::format("needs a cluster whose commands drive the vehicle: {} has no task with step actuator",
                                  cluster.file)});
  if (found.size() > 1)
    throw InputError(
        cluster.finding(found[1].task->line, found[1].path() + ".step", "actuator",
                        fmt::format("must be absent: {} has an actuator, and a vehicle has one", found[0].node->name)));
  const Task& task = *found[0].task;
  if (!is_by_time(task) || period_by_time(cluster, task) < kLeastBetween)
    throw InputError(cluster.finding(
        task.line, found[0].path() + ".activation", "",
        fmt::format("must be by time, once in {:g} ms at most: the task moves the vehicle", in_ms(kLeastBetween))));
  if (scenario.truth)
    throw InputError(
        {scenario.file, line, key, "", "must be absent with --truth: the trace says how the vehicle drives"});
  const Duration least = longest_in_true_time(task);
  const sim::world::vehicle::ActuatorConfig& actuator = *scenario.world.ego->actuator;
  if (actuator.dead_time < least)
    throw InputError({scenario.file, actuator.dead_time_line, key + ".dead_time",
                      fmt::format("{:g} ms", in_ms(actuator.dead_time)),
                      fmt::format("must be at least {:g} ms: nothing happens before the task {} of {} has ended",
                                  in_ms(least), task.name, cluster.file)});
  if (actuator.oldest >= oldest_distinct(cluster))
    throw InputError({scenario.file, actuator.oldest_line, key + ".oldest",
                      fmt::format("{:g} ms", in_ms(actuator.oldest)),
                      fmt::format("must be from 1 ms to below {:g} ms: stamps are told apart within a round of {}",
                                  in_ms(oldest_distinct(cluster)), cluster.file)});
  for (const schedules::model::Sensor& sensor : cluster.sensors) {
    const sensors::DriveError time = scenario.sensors.device_of(sensor).time;
    if (time.fixed != 0.0 || time.sigma != 0.0)
      throw InputError(
          {scenario.file, line, key, "",
           fmt::format("must be absent, since the stamps of {} err: a sensor cannot see where commands that "
                       "are still to come will drive the vehicle",
                       sensor.name)});
  }
}

std::string following_warning(const Scenario& scenario) {
  if (!scenario.world.ego || !scenario.world.ego->actuator || scenario.truth) return "";
  const auto follows = [](const sim::world::ObjectConfig& object) { return object.on && object.on->follow; };
  const auto first = std::ranges::find_if(scenario.world.objects, follows);
  if (first == scenario.world.objects.end()) return "";
  return Finding{
      scenario.file, scenario.world.ego->actuator_line, "world.ego.actuator", "",
      fmt::format("drives a vehicle that objects which follow do not see, such as {}: they may drive through "
                  "it",
                  first->name)}
      .sentence();
}

std::string unused_sections(const Scenario& scenario, std::span<const Cluster> clusters) {
  std::string text;
  for (const StepSection& section : scenario.step_sections) {
    if (std::ranges::any_of(clusters, [&](const Cluster& one) { return has_step(one, section.step); })) continue;
    if (!text.empty()) text += '\n';
    // The judge measures the error of the gap against this service's gap (experiments/sweep/driving.h).
    const bool judges =
        find_step(section.step)->role == StepRole::kCruise && scenario.world.ego && scenario.world.ego->actuator;
    text += Finding{scenario.file, section.line, section.step, "",
                    fmt::format("has no effect{}: no task of the cluster has this step",
                                judges ? " but on the judged error of the gap" : "")}
                .sentence();
  }
  return text;
}

Duration between_readings(const Cluster& cluster) {
  const std::vector<PlacedTask> found = tasks_with(cluster, StepRole::kActuator);
  if (found.empty() || !is_by_time(*found.front().task)) return kLeastBetween;
  return std::max(kLeastBetween, period_by_time(cluster, *found.front().task));
}

std::optional<NodeId> actuator_node(const Cluster& cluster) {
  const std::vector<PlacedTask> found = tasks_with(cluster, StepRole::kActuator);
  return found.empty() ? std::nullopt : cluster.find_node(found.front().node->name);
}

}  // namespace ttf::sim::drives
