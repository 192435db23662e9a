#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "cli/drive/drive_setup.h"
#include "cli/live_media/dds_configuration.h"
#include "cli/live_media/live_media.h"
#include "cli/node/node_command.h"
#include "cli/node/node_ending.h"
#include "cli/node_set/live_topics.h"
#include "cli/node_set/node_drive.h"
#include "cli/node_set/vehicle.h"
#include "cli/output.h"
#include "cli/supervision/control.h"
#include "cli/supervision/folder_lock.h"
#include "cli/supervision/signal_watch.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "nodes/runner/health_reporter.h"
#include "nodes/runner/kernel_clock.h"
#include "nodes/runner/runner.h"
#include "nodes/runner/thread_privileges.h"
#include "recording/records/enumerations.h"
#include "recording/records/tee.h"
#include "sim/drives/startup.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/surroundings.h"

namespace ttf::cli::node {
namespace {

using nodes::runner::Health;

// Shorter than a supervisor's wait for readiness.
constexpr std::chrono::milliseconds kLivePatience{10'000};

nlohmann::ordered_json health_json(const Health& health) {
  nlohmann::ordered_json json{
      {"missed_slots", health.timing.slots_missed},
      {"late_wakeups", health.timing.late_wakeups},
      {"lateness_us",
       {{"p50", in_us(health.wakeup_p50)}, {"p99", in_us(health.wakeup_p99)}, {"max", in_us(health.wakeup_longest)}}},
      {"drops", health.drops()}};
  if (health.state) {
    json["sync_precision_us"] = in_us(health.largest_offset);
    json["state"] = to_text(*health.state);
  }
  if (health.can_state) {
    json["can_errors"] = health.can_errors;
    json["can_state"] = to_text(*health.can_state);
  }
  if (health.vehicle) json["vehicle"] = node_set::vehicle_json(*health.vehicle);
  json["late_frames"] = health.timing.late_frames;
  json["early_frames"] = health.timing.early_frames;
  json["frames_lost"] = health.timing.frames_lost;
  json["medium"] = {{"sent", health.medium.sent},         {"received", health.medium.received},
                    {"not_sent", health.medium.not_sent}, {"lost", health.medium.lost},
                    {"foreign", health.medium.foreign},   {"malformed", health.medium.malformed},
                    {"dropped", health.dropped}};
  return json;
}

bus::ports::MachineTime from_utc(std::int64_t utc_ns) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return bus::ports::host_now() + Duration{utc_ns - std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()};
}

// The instant of the drive's time 0, and whether the node joins a running cluster.
struct Start {
  bus::ports::MachineTime origin;
  bool rejoins = false;
};

// Without a supervisor, a node needs the common instant of the begin: otherwise its drive would have a time of its own.
void check_common_start(const node_set::NodeSet& set) {
  if (!set.start_at_ns)
    throw InputError(
        {"command line", 0, "--start-at", "",
         "must be given to a node without a supervisor, in real time: the start of the drive for all its nodes, in "
         "UTC seconds since 1970; with --rejoin it may be past"});
}

Start common_start(const node_set::NodeSet& set) {
  const bus::ports::MachineTime origin = from_utc(*set.start_at_ns);
  if (!set.rejoin && origin < bus::ports::host_now())
    throw InputError({"command line", 0, "--start-at", scaled_text(*set.start_at_ns, 1'000'000'000),
                      "must be in the future; a node that joins a running drive needs --rejoin, too"});
  return {origin, set.rejoin};
}

// Explains the wait to the user.
void report_wait(const Start& start) {
  const Duration ahead = start.origin - bus::ports::host_now();
  if (ahead.ns > 0)
    fmt::print(stderr, "the drive begins in {:.1f} s (--start-at){}\n", ahead.seconds(),
               start.rejoins ? "; --rejoin finds no cluster before that" : "");
}

// Waits for the supervisor's start.
Start start_of(supervision::ControlLine& supervisor) {
  supervisor.ready();
  const auto facts = supervisor.wait_for_start();
  if (!facts) throw std::runtime_error("the supervisor ended before the start");
  try {
    return {{facts->at("origin_ns").get<std::int64_t>()}, facts->at("rejoin").get<bool>()};
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(fmt::format("the supervisor sent an invalid start message: {}", error.what()));
  }
}

// Returns a free name for the log. A restarted process keeps its predecessor's log; a node started by hand
// keeps those of earlier launches and nodes.
std::string free_log(const NodeOptions& options) {
  const std::filesystem::path path(options.log);
  std::string free = options.log;
  for (int n = 2; std::filesystem::exists(free); ++n)
    free = (path.parent_path() / fmt::format("{}.{}{}", path.stem().string(), n, path.extension().string())).string();
  if (free != options.log) fmt::print(stderr, "{} exists already: this log is {}\n", options.log, free);
  return free;
}

nodes::runner::RunnerConfig config_of(const NodeOptions& options, const Start& start, int stop_descriptor) {
  const node_set::NodeSet& set = options.set;
  nodes::runner::RunnerConfig config;
  config.cluster = &set.cluster;
  config.node = options.node;
  config.clock = nodes::runner::DriveClock(start.origin, set.time_scale_ppm);
  config.seed = set.seed;
  config.first_cycle = sim::engine::kFirstCycle;
  config.end = sim::drives::drive_end(set.scenario);
  config.stop_descriptor = stop_descriptor;
  if (start.rejoins) {
    config.power_on = TrueTime{};
  } else if (set.scenario.startup.cold) {
    config.cold = sim::drives::node_starts(set.scenario.startup, set.cluster, set.seed, 0)[index_of(options.node)];
    config.power_on = config.cold.how == nodes::host::ColdStart::kSleeps ? sim::engine::kFirstCycle
                                                                         : sim::engine::kFirstCycle + config.cold.after;
  }
  return config;
}

recording::log::LogManifest wall_manifest(const node_set::NodeSet& set) {
  recording::log::LogManifest manifest = drive::manifest_of(set.scenario, set.cluster, set.strategy, set.seed, {},
                                                            drive::pointer_to(set.steps), set.externals);
  manifest.clock = recording::log::kWallClock;
  manifest.host = set.host;
  manifest.time_scale_ppm = set.time_scale_ppm;
  return manifest;
}

}  // namespace

int run_node_live(const NodeOptions& options) {
  const node_set::NodeSet& set = options.set;
  supervision::SignalWatch signals;  // must precede all threads
  auto supervisor = supervision::ControlLine::from_environment();
  if (!supervisor) {
    check_common_start(set);
    supervision::FolderLock::refuse_if_held(set.folder);
    if (set.needs_dds()) live_media::check_dds_configuration();
  }
  if (set.topics) check_topics(set);
  create_folder(set.folder);
  const sim::drives::Surroundings around =
      sim::drives::surroundings_of(set.scenario, set.cluster, set.seed, 0, nullptr);
  const auto vehicle = node_set::vehicle_line(set, options.node, around);
  const sim::drives::NodeSetConfig code{
      &set.scenario, &set.cluster, set.strategy, set.seed, 0, around.scene, nullptr, drive::pointer_to(set.steps)};
  auto steps = sim::drives::make_steps(code, options.node);
  const auto medium =
      set.bus.medium->make({set.cluster, options.node, set.bus.interfaces, set.can_interfaces, set.session,
                            supervisor ? kLivePatience : std::chrono::milliseconds{0}, set.externals});
  if (set.topics) try_topics(set);
  const std::optional<Start> common = supervisor ? std::nullopt : std::optional(common_start(set));
  const std::string path = free_log(options);
  recording::log::LogWriter log(path, wall_manifest(set), recording::log::LogWriter::Writing::kBehind);
  if (common) report_wait(*common);
  const Start start = common ? *common : start_of(*supervisor);
  if (vehicle && start.rejoins && start.origin < bus::ports::host_now()) node_set::catch_up(*vehicle);
  nodes::runner::RunnerConfig config = config_of(options, start, signals.fd());
  config.vehicle = vehicle.get();
  std::unique_ptr<node_set::LiveTopics> topics;
  std::vector<recording::records::Sink*> sinks{&log};
  if (set.topics) {
    topics = make_topics(set, options.node, config.clock, around);
    for (recording::records::Sink* sink : topics->sinks()) sinks.push_back(sink);
  }
  recording::records::Tee tee(std::move(sinks));
  // Sends health to the supervisor and to ROS 2's topics.
  nodes::runner::HealthReporter reporter([&](const Health& health, bus::ports::MachineTime at) {
    if (supervisor) supervisor->health(health_json(health));
    if (topics) topics->health(health, config.clock.drive_time(at));
  });
  // All other threads exist already: they must not inherit the privileges.
  const auto not_granted = nodes::runner::ask_for_thread_privileges(index_of(options.node), set.cluster.nodes.size());
  if (supervisor)
    supervisor->health({{"not_granted", not_granted}});
  else
    print_warnings(not_granted);

  nodes::runner::KernelClock machine_clock(config.clock);
  nodes::runner::Runner node(config, std::move(steps), *medium, machine_clock, tee);
  node.on_health([&reporter](const Health& health) { reporter.hand_over(health); });
  const nodes::runner::RunnerEnd end = node.run();
  reporter.close();
  log.close();
  if (!supervisor) say_written(path);
  if (!supervisor && vehicle) node_set::warn_of_vehicle(set, options.node, vehicle->counts());
  const bool failed = end == nodes::runner::RunnerEnd::kFailed;
  report_ending(
      {node_set::counts_json(node.counts()), health_json(node.health()), failed ? medium->failure() : std::string()},
      supervisor, options.json);
  return 0;
}

}  // namespace ttf::cli::node
