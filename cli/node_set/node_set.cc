#include "cli/node_set/node_set.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/argument_checks.h"
#include "cli/decimal_option.h"
#include "cli/drive/drive_setup.h"
#include "cli/live_media/dds_configuration.h"
#include "cli/node_set/can_interfaces.h"
#include "cli/shipped.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "schedules/check/real_time_rules.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/traced.h"

namespace ttf::cli::node_set {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kLongestHost = 255;
constexpr Range<std::int64_t> kStarts_ns{0, 4'102'444'800 * kNsPerSecond};  // to the end of 2099

// The drive of a cluster without a scenario: the paper's first, with this cluster for every strategy.
sim::drives::Scenario default_scene(const schedules::model::Cluster& cluster) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  const std::string file = quoted(std::filesystem::absolute(cluster.file).string());
  return sim::drives::parse_scenario(fmt::format(R"(name: {}
description: "The default scene: a car ahead accelerates along the sensor vehicle's axis, from 30 m to 40 m within 1.5 s"
seed: 1
duration: 3 s
evaluate_from: 1500 ms
clusters: {{buff: {}, adva: {}, tt: {}}}
world:
  acceleration_noise: 2.0
  yaw_rate_noise: 0.05
  objects:
    - name: car
      x: 25.5
      y: 0.0
      speed: 1.5
      reference: true
      segments:
        - {{duration: 1500 ms, acceleration: 2.0}}
        - {{duration: 1500 ms, acceleration: 2.89}}
reference: {{}}
)",
                                                 quoted(cluster.name), file, file, file),
                                     "default_scene.yaml");
}

// Returns the system's name of this machine.
std::string this_host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

std::string host_option(const std::string& host) {
  const auto printable = [](unsigned char c) { return c > 0x20 && c < 0x7f; };
  if (host.empty() || host.size() > kLongestHost || !std::all_of(host.begin(), host.end(), printable))
    throw InputError({"command line", 0, "--host", host,
                      fmt::format("must be 1..{} printable ASCII characters without blanks", kLongestHost)});
  return host;
}

// --duration 0: the drive goes on until it is stopped.
bool is_zero(const std::string& duration) { return parse_scaled(duration, kNsPerSecond) == 0; }

// Refuses options of real time in virtual time.
void refuse_other_time(const NodeSetArguments& arguments, const live_media::Bus& bus) {
  const auto refuse = [](const char* option, const std::string& value, std::string_view why) {
    throw InputError({"command line", 0, option, value, fmt::format("must {}", why)});
  };
  if (!arguments.virtual_time) return;
  if (arguments.duration && is_zero(*arguments.duration))
    refuse("--duration", *arguments.duration, "not be 0 with --virtual-time, which nobody needs to stop");
  if (arguments.time_scale)
    refuse("--time-scale", *arguments.time_scale, "not be given with --virtual-time, which runs as fast as it can");
  if (arguments.start_at)
    refuse("--start-at", *arguments.start_at,
           "not be given with --virtual-time, which begins when all nodes are ready");
  if (arguments.rejoin)
    refuse("--rejoin", "", "not be given with --virtual-time: the other nodes do not wait for a late one");
  if (arguments.host)
    refuse("--host", *arguments.host, "not be given with --virtual-time, which uses no machine's clock");
  if (const std::string_view why = bus.medium->not_in_virtual_time; !why.empty())
    refuse("--bus", arguments.bus,
           fmt::format("be {} with --virtual-time: {}", live_media::kLiveMedia.front()->name, why));
}

InputError external_refused(const std::string& text, std::string expected) {
  return InputError({"command line", 0, "--external", text, std::move(expected)});
}

// Parses --external NODE[,NODE].
std::vector<NodeId> external_nodes(const std::string& text, const NodeSet& set) {
  if (set.virtual_time)
    throw external_refused(text, "must not be given with --virtual-time: a real node keeps real time");
  std::vector<NodeId> nodes;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const NodeId node = node_of(set.cluster, text.substr(from, comma - from), "--external", text);
    if (std::ranges::find(nodes, node) != nodes.end()) throw external_refused(text, "must name each node once");
    nodes.push_back(node);
    from = comma + 1;
  }
  if (nodes.size() == set.cluster.nodes.size()) throw external_refused(text, "must leave at least one node");
  return nodes;
}

void check_fit_for_real_time(const NodeSet& set) {
  if (const auto actuator = sim::drives::actuator_node(set.cluster);
      actuator && std::ranges::find(set.externals, *actuator) != set.externals.end())
    throw external_refused(set.cluster.node(*actuator).name,
                           "must not name the node with the actuator, whose process moves the vehicle");
  if (auto findings = schedules::check::check_real_time(set.cluster, set.time_scale_ppm); !findings.empty())
    throw InputError(std::move(findings));
  if (!set.scenario.faults.empty())
    throw InputError({set.scenario.file, set.scenario.faults.faults.front().line, "faults", "",
                      "need --virtual-time: faults are injected in virtual time only"});
  const bool a_alone = !set.bus.carries(schedules::model::Channel::kB);
  for (const schedules::model::FrameSlot& frame : set.cluster.frames)
    if (a_alone && frame.channels == schedules::model::Channels::kB)
      throw InputError({"command line", 0, "--bus", set.bus.text(),
                        fmt::format("must name an interface for channel B, too: slot {} of {} is sent on B alone",
                                    frame.slot, set.cluster.file)});
}

}  // namespace

void add_node_set_options(CLI::App& command, NodeSetArguments& arguments) {
  command
      .add_option("scenario", arguments.scenario,
                  "Scenario file, or a cluster file for the default scene; or a shipped one's name")
      ->required();
  command
      .add_option("--strategy", arguments.strategy, "Fusion strategy, and with it the scenario's cluster (default: tt)")
      ->check(one_of(drive::strategy_names()));
  command.add_option("--seed", arguments.seed, "Seed of every random stream, instead of the scenario's");
  command.add_option("--bus", arguments.bus, live_media::bus_help());
  command
      .add_option("--can", arguments.cans,
                  "NAME=IF: the interface of a private CAN on socketcan, once for each (default: its NAME)")
      ->allow_extra_args(false);
  command.add_option(
      "--session", arguments.session,
      "Name of the drive on dds, for all its nodes and no others (default: ttfusion; launch: a new one)");
  command.add_option("--external", arguments.external,
                     "NODE[,NODE]: real nodes that take these nodes' places on the bus (docs/media/own_code.md)");
  command.add_flag("--virtual-time", arguments.virtual_time,
                   "Drive in virtual time, as fast as possible, instead of in real time");
  command.add_flag("--no-topics", arguments.no_topics, "Publish nothing for ROS 2 (docs/media/dds.md) in real time");
  command.add_option("--time-scale", arguments.time_scale, "Stretch the schedule in real time, 0.1..1000");
  command.add_option("--duration", arguments.duration,
                     "Seconds to drive, instead of the scenario's; 0: until it is stopped, an hour at most");
  command
      .add_option("--truth", arguments.truth,
                  "ASAM OSI trace in place of the scenario's objects (docs/reference/exchange.md)")
      ->check(named());
  drive::add_step_options(command, arguments.steps);
}

NodeSet read_node_set(const NodeSetArguments& arguments) {
  NodeSet set;
  set.file = file_named(arguments.scenario, {kScenarios, kSchedules});
  set.strategy = drive::strategy_of(arguments.strategy);
  if (arguments.virtual_time && !live_media::kWithDds)  // before --bus, which has no default then
    throw InputError({"command line", 0, "--virtual-time", "",
                      "must not be given: it needs DDS, which this build leaves out; `ttfusion run` does without"});
  set.bus = live_media::Bus::parse(arguments.bus);
  live_media::check_session_name(arguments.session);
  set.session = arguments.session;
  set.virtual_time = arguments.virtual_time;
  set.topics = live_media::kWithDds && !arguments.no_topics && !arguments.virtual_time;
  if (arguments.time_scale) set.time_scale_ppm = time_scale_option(*arguments.time_scale);
  refuse_other_time(arguments, set.bus);
  if (arguments.start_at)
    set.start_at_ns = decimal_option("--start-at", *arguments.start_at, kNsPerSecond, kStarts_ns, " s");
  set.rejoin = arguments.rejoin;
  set.host = arguments.host ? host_option(*arguments.host) : this_host();

  set.step_options = arguments.steps;
  set.steps = drive::step_folder(arguments.steps);

  std::string drive = set.file;  // the name in messages
  if (kind_of_file(set.file) == FileKind::kCluster) {
    set.cluster = drive::checked_cluster(set.file);
    set.scenario = default_scene(set.cluster);
    drive = "the default scene";
  } else {
    set.scenario = sim::drives::load_scenario(set.file);
    set.cluster = drive::checked_cluster(set.scenario, set.strategy);
  }
  if (sensors::recorded::is_recorded(set.cluster))
    throw InputError({set.file, 0, "clusters", set.cluster.file,
                      "must be a cluster with sensors; recordings are for `ttfusion run --input`"});
  set.seed = arguments.seed ? drive::seed_of(*arguments.seed) : set.scenario.seed;
  set.until_stopped = arguments.duration && is_zero(*arguments.duration);
  if (set.until_stopped)
    set.scenario.duration = set.scenario.world.duration = drive::kLongestDrive;
  else if (arguments.duration)
    drive::set_duration(set.scenario, drive, *arguments.duration);
  if (const auto truth = drive::read_truth(arguments.truth)) {
    sim::drives::take_truth(set.scenario, truth);
    set.until_stopped = false;  // it ends with the trace
  }
  sim::drives::check_fits(set.scenario, set.cluster, set.strategy, false);
  set.can_interfaces = can_interfaces(set.cluster, set.bus, arguments.cans);
  if (arguments.external) set.externals = external_nodes(*arguments.external, set);
  if (!set.virtual_time) check_fit_for_real_time(set);
  set.folder = arguments.out.empty() ? drive::folder_of(set.scenario) + "/launch" : arguments.out;
  return set;
}

std::vector<std::string> NodeSet::options() const {
  std::vector<std::string> list{file,
                                "--strategy",
                                std::string(name_of(strategy)),
                                "--seed",
                                fmt::to_string(seed),
                                "--bus",
                                bus.text(),
                                "--session",
                                session,
                                "--duration",
                                scaled_text(scenario.duration.ns, kNsPerSecond)};
  for (std::string& option : can_options(cluster, can_interfaces)) list.push_back(std::move(option));
  if (!externals.empty()) {
    std::vector<std::string> names;
    for (const NodeId node : externals) names.push_back(cluster.node(node).name);
    list.insert(list.end(), {"--external", fmt::format("{}", fmt::join(names, ","))});
  }
  if (start_at_ns) list.insert(list.end(), {"--start-at", scaled_text(*start_at_ns, kNsPerSecond)});
  if (rejoin) list.emplace_back("--rejoin");
  if (virtual_time)
    list.emplace_back("--virtual-time");
  else
    list.insert(list.end(), {"--time-scale", schedules::check::time_scale_text(time_scale_ppm)});
  if (!virtual_time && !topics) list.emplace_back("--no-topics");
  if (scenario.truth) list.insert(list.end(), {"--truth", scenario.truth->name});
  for (std::string& option : step_options.arguments()) list.push_back(std::move(option));
  list.insert(list.end(), {"--out", folder});
  return list;
}

NodeId node_of(const schedules::model::Cluster& cluster, const std::string& name, const std::string& argument,
               const std::string& text) {
  if (const auto node = cluster.find_node(name)) return *node;
  std::vector<std::string> names;
  for (const schedules::model::Node& node : cluster.nodes) names.push_back(node.name);
  throw InputError({"command line", 0, argument, text,
                    fmt::format("must name a node of {}: {}", cluster.file, fmt::join(names, ", "))});
}

}  // namespace ttf::cli::node_set
