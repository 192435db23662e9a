#include "sim/drives/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>

#include "core/counted.h"
#include "core/ids.h"
#include "core/nearest.h"
#include "core/strict_yaml.h"
#include "faults/believed_schedule.h"
#include "nodes/fusion/fusion_host.h"
#include "recording/records/every.h"
#include "recording/records/tee.h"
#include "sensors/kinds/loader.h"
#include "sim/drives/known_fields.h"
#include "sim/drives/played_recording.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/surroundings.h"

namespace ttf::sim::drives {
namespace {

// Filters records when each process simulates one node: each keeps its own node's records, the first also those
// of no node. All processes see the records that belong to no executive: signals' ways on the channels,
// guardians' interventions, faults. Together they keep each of these once.
class Share final : public recording::records::Every<Share> {
 public:
  Share(NodeId self, recording::records::Sink& out) : self_(self), out_(out) {}
  template <class Record> void each(const Record& record) {
    if constexpr (std::is_same_v<Record, recording::records::FaultActivity>) {
      if (!is_mine(record.node)) return;
    } else if constexpr (std::is_same_v<Record, recording::records::GuardianIntervention>) {
      if (!is_mine(record.branch)) return;
    } else if constexpr (std::is_same_v<Record, recording::records::ChannelFrame>) {
      if (!is_mine(record.sender)) return;
    }
    out_.on(record);
  }

 private:
  bool is_mine(NodeId node) const { return node == self_ || (node == kNoNode && self_ == NodeId{}); }

  NodeId self_;
  recording::records::Sink& out_;
};

// A sleeping node has its supply from the start on.
void start_cold(sim::engine::SimulationConfig& config, const std::vector<nodes::host::NodeStart>& starts) {
  config.power_on = [starts](NodeId node) -> std::optional<TrueTime> {
    const nodes::host::NodeStart& cold = starts[index_of(node)];
    return cold.how == nodes::host::ColdStart::kSleeps ? sim::engine::kFirstCycle
                                                       : sim::engine::kFirstCycle + cold.after;
  };
  config.cold = [starts](NodeId node) { return starts[index_of(node)]; };
}

DriveOutcome outcome_of(const sim::engine::ClusterSimulation& simulation, const schedules::model::Cluster& cluster,
                        Duration elapsed, const sim::faults::Injector* injector) {
  DriveOutcome outcome;
  outcome.precision = simulation.precision();
  outcome.counts = simulation.counts();
  outcome.frames_sent = simulation.frames_sent();
  if (injector != nullptr) outcome.faults.assign(injector->activations().begin(), injector->activations().end());
  outcome.flexray_load = simulation.flexray_busy().seconds() / elapsed.seconds();
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    outcome.can_load.push_back(simulation.can_busy(b).seconds() / elapsed.seconds());
  return outcome;
}

// Noise of its own has only a sensor that plays the recording.
void check_recorded_sensors(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  std::vector<std::string> names;
  for (const SensorId sensor : played_sensors(cluster)) names.push_back(cluster.sensor(sensor).name);
  for (const auto& own : scenario.recorded_noises.own)
    if (std::find(names.begin(), names.end(), own.sensor) == names.end())
      throw InputError({scenario.file, own.line, "recorded.sensors." + own.sensor, "",
                        fmt::format("must be a sensor of {} that plays the recording: {}{}", cluster.file,
                                    joined(names, " or "), did_you_mean(own.sensor, names))});
}

}  // namespace

TrueTime drive_start(const schedules::model::Cluster& cluster) {
  if (!sensors::recorded::is_recorded(cluster)) return sim::engine::kFirstCycle;
  // Row 0 of the recording is the first measurement of the first sensor.
  return sim::engine::kFirstCycle + sensors::recorded::first_measurement(cluster, cluster.sensors.front());
}

TrueTime evaluation_start(const Scenario& scenario) { return sim::engine::kFirstCycle + scenario.evaluate_from; }
TrueTime drive_end(const Scenario& scenario) { return sim::engine::kFirstCycle + scenario.duration; }

void check_recording(const Scenario& scenario, const schedules::model::Cluster& cluster, bool given) {
  const bool needed = sensors::recorded::is_recorded(cluster);
  if (needed && scenario.truth)
    throw InputError({scenario.file, 0, "clusters", cluster.file,
                      "plays a recording, so --truth would be ignored: it has a task with step recorded_source"});
  if (needed && !given)
    throw InputError({scenario.file, 0, "clusters", cluster.file, "needs a recording: give one with --input"});
  if (!needed && given)
    throw InputError({scenario.file, 0, "clusters", cluster.file,
                      "takes no recording, so --input would be ignored: it has no task with step recorded_source"});
  if (needed && scenario.startup.cold)
    throw InputError({scenario.file, 0, "startup", "cold",
                      "must be integrated: a recording begins with cycle 0, whose instant is unknown in a cold start"});
  if (needed) check_recorded_sensors(scenario, cluster);
  for (const schedules::model::Sensor& sensor : cluster.sensors)
    if (needed && sensor.follows())
      throw InputError(cluster.finding(sensor.line, "sensors." + sensor.name + ".measurement", "completion",
                                       "must be free or scheduled: recorded observations have fixed instants"));
}

void check_late(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy) {
  const fusion::oosm::Kind late = scenario.tracker.late;
  if (late == fusion::oosm::Kind::kRewind) return;  // always possible; computing the sensors' timing takes a while
  const std::string refusal = fusion::strategies::late_refusal(strategy, late, nodes::fusion::sensor_timings(cluster));
  if (refusal.empty()) return;
  Findings none;
  const int line = StrictYaml::parse(scenario.text, scenario.file).root(none).map("tracker").line("late");
  throw InputError({scenario.file, line, "tracker.late", std::string(name_of(late)), refusal});
}

void check_fusion(const schedules::model::Cluster& cluster, fusion::strategies::StrategyKind strategy) {
  if (fusion::strategies::row_of(strategy).relies_on != fusion::strategies::ReliesOn::kSchedule) return;
  for (const PlacedTask& fusion : tasks_with(cluster, StepRole::kFusion))
    if (fusion.task->activation.kind != schedules::model::ActivationKind::kTime)
      throw InputError(cluster.finding(
          fusion.task->line, fusion.path() + ".activation", "",
          fmt::format("must be of kind time with strategy {}, which relies on fusion instants that the schedule knows",
                      name_of(strategy))));
}

void check_described(const schedules::model::Cluster& cluster) {
  if (cluster.describes_tasks()) return;
  const auto line = cluster.parameter_lines.find("nodes");
  throw InputError(cluster.finding(line == cluster.parameter_lines.end() ? 0 : line->second, "nodes", "",
                                   "must have tasks for a drive: no node has any"));
}

// Checks the cluster that drives: it may have the instants of a recording.
static void check_cluster(const Scenario& scenario, const schedules::model::Cluster& cluster,
                          fusion::strategies::StrategyKind strategy) {
  check_late(scenario, cluster, strategy);
  check_fusion(cluster, strategy);
  sensors::kinds::check_sensors(scenario.sensors, scenario.text, scenario.file, cluster);
  check_loop(scenario, cluster);
  check_tasks(scenario, cluster);
}

void check_fits(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy, bool recording_given) {
  check_described(cluster);
  check_recording(scenario, cluster, recording_given);
  check_cluster(scenario, cluster, strategy);
  const ttf::faults::FaultPlan faults = ttf::faults::resolve(scenario.faults, cluster);
  const ttf::faults::BelievedSchedules believed(faults, cluster);
  if (scenario.startup.cold) (void)node_starts(scenario.startup, cluster, scenario.seed, 0);
  (void)tracker_of(scenario, cluster);
}

DriveOutcome run_drive(const DriveConfig& config, recording::records::Sink& out) {
  const Scenario& scenario = *config.scenario;
  check_described(*config.cluster);
  check_recording(scenario, *config.cluster, config.recorded != nullptr);
  // The devices' instants may be the recording's.
  std::optional<schedules::model::Cluster> played;
  if (config.recorded) played = cluster_that_plays(scenario, *config.cluster, *config.recorded);
  const schedules::model::Cluster& cluster = played ? *played : *config.cluster;
  check_cluster(scenario, cluster, config.strategy);
  std::optional<Share> share;
  if (config.others != nullptr) share.emplace(config.others->self(), out);
  recording::records::Sink& sink = share ? static_cast<recording::records::Sink&>(*share) : out;
  const Surroundings around = surroundings_of(scenario, cluster, config.seed, config.replication, config.recorded);
  Observer observer(*around.scene, cluster.nodes.size(), sink);
  around.show(observer, scenario, cluster);
  recording::records::Tee tee({&sink, &observer});

  const NodeSetConfig nodes{&scenario,          &cluster,     config.strategy, config.seed,
                            config.replication, around.scene, config.recorded, config.steps};
  sim::engine::SimulationConfig simulation_config;
  simulation_config.cluster = &cluster;
  simulation_config.seed = config.seed;
  simulation_config.replication = config.replication;
  simulation_config.make_steps = [&](NodeId node) { return make_steps(nodes, node); };
  if (scenario.startup.cold)
    start_cold(simulation_config, node_starts(scenario.startup, cluster, config.seed, config.replication));
  const ttf::faults::FaultPlan faults = ttf::faults::resolve(scenario.faults, cluster);
  const ttf::faults::BelievedSchedules believed(faults, cluster);
  simulation_config.view = [&](NodeId node) { return believed.of(node); };
  if (sim::world::vehicle::Driven* const driven = around.world ? around.world->world().driven() : nullptr)
    simulation_config.actuate = [driven, start = drive_start(cluster)](const nodes::host::Actuation& actuation) {
      driven->actuate({TrueTime{} + (actuation.from - start), actuation.acceleration, actuation.steering});
    };
  simulation_config.others = config.others;
  simulation_config.compares_clocks = config.compares_clocks;
  simulation_config.cans_bit_by_bit = config.cans_bit_by_bit;
  sim::engine::ClusterSimulation simulation(simulation_config, tee);
  std::optional<sim::faults::Injector> injector;
  if (!faults.empty()) {
    injector.emplace(faults, cluster, simulation, config.seed, config.replication, tee, sim::engine::kFirstCycle);
    simulation.set_disturbance(&*injector);
  }
  simulation.run_until(drive_end(scenario));
  return outcome_of(simulation, cluster, scenario.duration, injector ? &*injector : nullptr);
}

}  // namespace ttf::sim::drives
