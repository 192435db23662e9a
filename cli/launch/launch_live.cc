#include "cli/launch/launch_live.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "cli/drive/drive_setup.h"
#include "cli/launch/launch_result.h"
#include "cli/node_set/node_drive.h"
#include "cli/node_set/vehicle.h"
#include "evaluation/cluster/bus_use.h"
#include "recording/log/writer.h"
#include "recording/merge/merge.h"
#include "sim/drives/observer.h"
#include "sim/drives/surroundings.h"

namespace ttf::cli::launch {
namespace {

// From the last readiness to the begin: time for every process to receive the start and lock its memory.
constexpr Duration kUntilStart = Duration::milliseconds(500);
// The begin is a round instant of the machine's clock. So the drive's cycles have a fixed place among the
// kernel's own ticks in every launch.
constexpr std::int64_t kRound_ns = 100'000'000;
// Nodes that are stopped together end some milliseconds apart: each closes its log first.
constexpr Duration kTogether = Duration::milliseconds(500);

// Gives the vehicle the commands of the actuator's log.
class LoggedCommands final : public recording::records::Sink {
 public:
  LoggedCommands(sim::world::vehicle::Driven& driven, TrueTime start) : driven_(driven), start_(start) {}
  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::CommandTaken& taken) override {
    if (taken.verdict == recording::records::CommandVerdict::kApplied)
      (void)driven_.insert({TrueTime{} + (taken.from - start_), taken.acceleration, taken.steering});
  }

 private:
  sim::world::vehicle::Driven& driven_;
  TrueTime start_;
};

// Nodes do not have the truth: it is computed at the instants of the nodes' records.
void write_truth(const node_set::NodeSet& set, const sim::drives::Surroundings& around,
                 const recording::merge::MergedLogs& nodes, const std::string& path) {
  const auto log = drive::begin_log(path, nodes.manifest(), set.scenario, set.cluster);
  sim::drives::Observer observer(*around.scene, set.cluster.nodes.size(), *log);
  around.show(observer, set.scenario, set.cluster);
  nodes.read(observer);
  log->close();
}

}  // namespace

LiveLaunch::LiveLaunch(const LaunchPlan& plan)
    : set_(plan.set), around_(sim::drives::surroundings_of(set_.scenario, set_.cluster, set_.seed, 0, nullptr)),
      vehicle_(node_set::vehicle_line_of_launch(set_, around_)),
      processes_(plan.set.cluster.nodes.size() - plan.set.externals.size()) {
  if (!plan.set.externals.empty()) listening_.emplace(plan.set, plan.set.externals);
}

supervision::Hooks LiveLaunch::hooks() {
  supervision::Hooks hooks;
  if (listening_ || vehicle_)
    hooks.listen = [this] {
      if (listening_) listening_->take_in();
      if (vehicle_) vehicle_->take_in();
    };
  if (listening_) {
    hooks.external = [this](std::size_t node) {
      return listening_->health(static_cast<NodeId>(node), bus::ports::host_now());
    };
  }
  hooks.on_all_ready = [this] {
    const bus::ports::MachineTime soonest = bus::ports::host_now() + kUntilStart;
    origin_ = bus::ports::MachineTime{(soonest.ns + kRound_ns - 1) / kRound_ns * kRound_ns};
    if (listening_) listening_->begin(*origin_);
    return nlohmann::json{{"origin_ns", origin_->ns}, {"rejoin", false}};
  };
  hooks.on_late_ready = [this](std::size_t) {
    return nlohmann::json{{"origin_ns", origin_.value_or(bus::ports::host_now()).ns}, {"rejoin", true}};
  };
  hooks.on_health = [this](std::size_t node, const nlohmann::json& facts) {
    if (!facts.is_object()) return;
    if (facts.contains("vehicle")) vehicle_problems_[node] = node_set::vehicle_problem(facts["vehicle"]);
    if (!facts.contains("not_granted")) return;
    for (const nlohmann::json& sentence : facts["not_granted"])
      if (sentence.is_string()) not_granted_[sentence.get<std::string>()].insert(node);
  };
  hooks.status = [this] {
    const Duration far = so_far(bus::ports::host_now());
    if (set_.until_stopped) return fmt::format("{:.0f} s", far.seconds());
    return fmt::format("{:.0f} of {:g} s", far.seconds(), set_.scenario.duration.seconds());
  };
  hooks.on_done = [this](std::size_t, const nlohmann::json& facts) {
    // A node that ends alone leaves the others on their drive.
    const bus::ports::MachineTime now = bus::ports::host_now();
    if (!last_done_ || now - *last_done_ > kTogether) ended_ = now;
    last_done_ = now;
    if (!facts.is_object() || !facts.contains("counts"))
      throw std::runtime_error("the outcome of a node has no counts");
    node_set::add_counts(outcome_.counts, facts["counts"]);
  };
  return hooks;
}

// In the drive's time, which the machine's is a stretch of.
Duration LiveLaunch::so_far(bus::ports::MachineTime now) const {
  if (!origin_) return {};
  const Duration real = now - *origin_;
  const double drive_s = real.seconds() * 1e6 / static_cast<double>(set_.time_scale_ppm);
  return std::clamp(Duration{static_cast<std::int64_t>(drive_s * 1e9)}, Duration{}, set_.scenario.duration);
}

// Nodes end some milliseconds apart, by clocks of their own.
Duration LiveLaunch::driven() const {
  constexpr Duration kApart = Duration::milliseconds(100);
  const Duration far = so_far(ended_.value_or(bus::ports::host_now()));
  return far + kApart < set_.scenario.duration ? far : set_.scenario.duration;
}

std::vector<std::string> LiveLaunch::states_at_end(const supervision::HealthTable& health,
                                                   const drive::StrategyResult*) const {
  std::vector<std::string> states;
  for (std::size_t node = 0; node < set_.cluster.nodes.size(); ++node) states.push_back(health.of(node).state);
  for (const external::Account& account : accounts())
    states[index_of(*set_.cluster.find_node(account.node))] =
        account.counts.first && !account.silent ? "" : state_text(account);
  return states;
}

std::vector<external::Account> LiveLaunch::accounts() const {
  return listening_ ? listening_->accounts(bus::ports::host_now()) : std::vector<external::Account>{};
}

std::vector<std::string> LiveLaunch::warnings() const {
  std::vector<std::string> warnings;
  for (const auto& [sentence, nodes] : not_granted_)
    warnings.push_back(fmt::format("{} of {} nodes: {}", nodes.size(), processes_, sentence));
  for (const auto& [node, problem] : vehicle_problems_)
    if (!problem.empty()) warnings.push_back(fmt::format("{} {}", set_.cluster.nodes[node].name, problem));
  if (listening_)
    for (std::string& sentence : listening_->warnings()) warnings.push_back(std::move(sentence));
  return warnings;
}

std::optional<drive::StrategyResult> LiveLaunch::result(const std::vector<std::string>& logs) const {
  std::vector<std::string> all = readable_logs(logs);
  if (all.empty()) return std::nullopt;
  const std::string truth = fmt::format("{}/{}", set_.folder, kTruthLog);
  const recording::merge::MergedLogs nodes(all);
  // The launch has received each command itself, even those of a killed process. If not, the logs have them.
  if (vehicle_ && !vehicle_->counts().whole) {
    LoggedCommands logged(*around_.world->world().driven(), sim::drives::drive_start(set_.cluster));
    nodes.read(logged);
  }
  write_truth(set_, around_, nodes, truth);
  all.push_back(truth);
  evaluation::cluster::BusUse use(set_.cluster);
  drive::StrategyResult result = merged_result(set_, all, {&use});
  result.outcome = outcome_;
  result.outcome.frames_sent = use.frames_sent();
  result.outcome.flexray_load = use.flexray_load(set_.scenario.duration);
  result.outcome.can_load = use.can_load(set_.scenario.duration);
  return result;
}

}  // namespace ttf::cli::launch
