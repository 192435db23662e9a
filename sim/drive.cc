#include "sim/drive.h"

#include <optional>
#include <utility>

#include "nodes/believed_schedule.h"
#include "nodes/catalog.h"
#include "nodes/recorded.h"
#include "recording/records/tee.h"
#include "sim/share.h"
#include "sim/world/reference.h"

namespace ttf::sim {
namespace {

// Adds what nobody in the cluster knows to the records of the run.
class Observer final : public records::Sink {
 public:
  Observer(const nodes::Scene& scene, records::Sink& out) : scene_(scene), out_(out) {
    states_.reserve(scene.objects());
  }

  // `integrated`: cycle 0 starts at kFirstCycle.
  void follow(const world::Reference* reference, const world::World* world, TrueTime start, bool integrated) {
    reference_ = reference;
    world_ = world;
    start_ = start;
    integrated_ = integrated;
  }

  using records::Sink::on;
  void on(const records::Measured& measured) override { truth(measured.stamp); }
  void on(const records::FeatureUsed& used) override { truth(used.stamp); }
  void on(const records::FusionStep& step) override {
    if (reference_ == nullptr) return;
    while (true) {
      const world::Fix fix = reference_->fix(next_fix_, *world_);
      const Duration since_start = start_ - TrueTime{};
      if (fix.available + since_start > step.stamp.true_time) return;
      records::ReferenceFix record;
      record.measured_true = fix.measured + since_start;
      record.measured_local = LocalTime{record.measured_true.ns};
      record.measured = global_of(record.measured_true, step.stamp);
      record.available = global_of(fix.available + since_start, step.stamp);
      record.object = fix.object;
      record.x = fix.x;
      record.y = fix.y;
      record.sigma = reference_->sigma();
      record.vx = fix.vx;
      record.vy = fix.vy;
      record.sigma_velocity = reference_->velocity_sigma();
      out_.on(record);
      ++next_fix_;
    }
  }

 private:
  // GPS time is the reference's own. It is on the cluster's scale by its offset to cycle 0, known after the drive;
  // where nobody knows beforehand when that is, and at which rate the cluster will count, by the reading of the fusion
  // node's clock when it took the fix in.
  GlobalTime global_of(TrueTime at, const records::Stamp& fused) const {
    return integrated_ ? GlobalTime{} + (at - kFirstCycle) : fused.global + (at - fused.true_time);
  }

  void truth(const records::Stamp& stamp) {
    const TrueTime at = stamp.true_time;
    const std::pair<TrueTime, NodeId> instant{at, stamp.node};
    if (last_truth_ == instant) return;
    last_truth_ = instant;
    scene_.states_at(at, states_);
    for (const world::ObjectState& state : states_)
      out_.on(records::TruthState{at, state.id, state.x, state.y, state.heading, state.speed, state.acceleration,
                                  state.yaw_rate, state.length, state.width, stamp.local, stamp.global, stamp.node});
  }

  const nodes::Scene& scene_;
  records::Sink& out_;
  const world::Reference* reference_ = nullptr;
  const world::World* world_ = nullptr;
  TrueTime start_{};
  bool integrated_ = true;
  std::uint32_t next_fix_ = 0;
  std::vector<world::ObjectState> states_;
  std::optional<std::pair<TrueTime, NodeId>> last_truth_;
};

}  // namespace

TrueTime drive_start(const schedules::Cluster& cluster) {
  if (!nodes::is_recorded(cluster)) return kFirstCycle;
  // Row 0 of the recording is the first measurement of the first sensor.
  const schedules::Sensor& sensor = cluster.sensors.front();
  const GlobalTime first = sensor.scheduled
                               ? schedules::next_occurrence(cluster.flexray, sensor.at, GlobalTime{}).time
                               : GlobalTime{} + sensor.phase.value_or(Duration{});
  return kFirstCycle + (first - GlobalTime{});
}

TrueTime evaluation_start(const nodes::Scenario& scenario) { return kFirstCycle + scenario.evaluate_from; }
TrueTime drive_end(const nodes::Scenario& scenario) { return kFirstCycle + scenario.duration; }

void check_recording(const nodes::Scenario& scenario, const schedules::Cluster& cluster, bool given) {
  const bool needed = nodes::is_recorded(cluster);
  if (needed && !given)
    throw InputError({scenario.file, 0, "clusters", cluster.file, "needs a recording: give one with --input"});
  if (!needed && given)
    throw InputError({scenario.file, 0, "clusters", cluster.file,
                      "takes no recording, so --input would be ignored: it has no task with step recorded_source"});
  if (needed && scenario.startup.cold)
    throw InputError({scenario.file, 0, "startup", "cold",
                      "must be integrated: a recording begins with cycle 0, and nobody knows when that will be"});
}

void check_fits(const nodes::Scenario& scenario, const schedules::Cluster& cluster, bool recording_given) {
  check_recording(scenario, cluster, recording_given);
  const nodes::FaultPlan faults = nodes::resolve(scenario.faults, cluster);
  const nodes::BelievedSchedules believed(faults, cluster);
  if (scenario.startup.cold) (void)nodes::node_starts(scenario.startup, cluster, scenario.seed, 0);
}

DriveOutcome run_drive(const DriveConfig& config, records::Sink& out) {
  const schedules::Cluster& cluster = *config.cluster;
  const nodes::Scenario& scenario = *config.scenario;
  const bool recorded = nodes::is_recorded(cluster);
  const TrueTime start = drive_start(cluster);
  check_recording(scenario, cluster, config.recorded != nullptr);

  std::shared_ptr<const nodes::Scene> scene;
  std::shared_ptr<const nodes::WorldScene> world;
  std::optional<world::Reference> reference;
  if (recorded) {
    scene = std::make_shared<nodes::RecordedScene>(*config.recorded, start);
  } else {
    world = std::make_shared<nodes::WorldScene>(scenario.world, config.seed, config.replication, start);
    scene = world;
    for (const world::ObjectConfig& object : scenario.world.objects)
      if (object.reference && !reference)
        reference.emplace(scenario.reference, scenario.world, config.seed, config.replication);
  }

  std::optional<Share> share;
  if (config.others != nullptr) share.emplace(config.others->self(), out);
  records::Sink& sink = share ? static_cast<records::Sink&>(*share) : out;
  Observer observer(*scene, sink);
  if (reference) observer.follow(&*reference, &world->world(), start, !scenario.startup.cold);
  records::Tee tee({&sink, &observer});

  const nodes::NodeSetConfig nodes{&scenario, &cluster, config.strategy, config.seed, config.replication, scene,
                                   config.recorded};
  SimulationConfig simulation_config;
  simulation_config.cluster = &cluster;
  simulation_config.seed = config.seed;
  simulation_config.replication = config.replication;
  simulation_config.make_steps = [&](NodeId node) { return nodes::make_steps(nodes, node); };
  std::vector<nodes::NodeStart> starts;
  if (scenario.startup.cold) {
    starts = nodes::node_starts(scenario.startup, cluster, config.seed, config.replication);
    // Who sleeps has its supply from the start on.
    simulation_config.power_on = [&](NodeId node) -> std::optional<TrueTime> {
      const nodes::NodeStart& cold = starts[index_of(node)];
      return cold.how == nodes::ColdStart::kSleeps ? kFirstCycle : kFirstCycle + cold.after;
    };
    simulation_config.cold = [&](NodeId node) { return starts[index_of(node)]; };
  }
  const nodes::FaultPlan faults = nodes::resolve(scenario.faults, cluster);
  const nodes::BelievedSchedules believed(faults, cluster);
  simulation_config.view = [&](NodeId node) { return believed.of(node); };
  simulation_config.others = config.others;
  ClusterSimulation simulation(simulation_config, tee);
  std::optional<Injector> injector;
  if (!faults.empty()) {
    injector.emplace(faults, cluster, simulation, config.seed, config.replication, tee, kFirstCycle);
    simulation.set_disturbance(&*injector);
  }
  simulation.run_until(drive_end(scenario));

  DriveOutcome outcome;
  outcome.precision = simulation.precision();
  outcome.counts = simulation.counts();
  outcome.frames_sent = simulation.frames_sent();
  if (injector) outcome.faults.assign(injector->activations().begin(), injector->activations().end());
  const double elapsed = scenario.duration.seconds();
  outcome.flexray_load = simulation.flexray_busy().seconds() / elapsed;
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    outcome.can_load.push_back(simulation.can_busy(b).seconds() / elapsed);
  return outcome;
}

}  // namespace ttf::sim
