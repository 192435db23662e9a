#include "cli/node_set.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/drive_setup.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/strict_yaml.h"
#include "nodes/catalog.h"
#include "sim/drive.h"

namespace ttf::cli {
namespace {

constexpr std::int64_t kPpm = 1'000'000, kNsPerSecond = 1'000'000'000;
constexpr Range<std::int64_t> kTimeScales{kPpm / 10, 1000 * kPpm};
constexpr Range<std::int64_t> kDurations_ns{kNsPerSecond / 10, 3600 * kNsPerSecond};   // as a scenario's

// The drive of a cluster that is given without one: the paper's first, on this cluster whatever the strategy.
nodes::Scenario default_scene(const schedules::Cluster& cluster) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  const std::string file = quoted(std::filesystem::absolute(cluster.file).string());
  return nodes::parse_scenario(
      fmt::format(R"(name: {}
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

// A cluster file has FlexRay parameters, a scenario names clusters.
bool is_cluster_file(const std::string& file) {
  const StrictYaml yaml = StrictYaml::load(file);
  Findings ignored;
  const YamlMap root = yaml.root(ignored);
  return root.has("flexray") && !root.has("clusters");
}

std::int64_t decimal_option(const char* option, const std::string& text, std::int64_t scale, Range<std::int64_t> allowed,
                            std::string_view unit) {
  const auto value = parse_scaled(text, scale);
  if (!value || !allowed.contains(*value))
    throw InputError({"command line", 0, option, text,
                      fmt::format("must be a decimal number {}..{}{}", scaled_text(allowed.low, scale),
                                  scaled_text(allowed.high, scale), unit)});
  return *value;
}

void set_duration(nodes::Scenario& scenario, const std::string& text) {
  const Duration duration{decimal_option("--duration", text, kNsPerSecond, kDurations_ns, " s")};
  if (duration < scenario.evaluate_from)
    throw InputError({"command line", 0, "--duration", text,
                      fmt::format("must be at least {} s: from there on {} is evaluated",
                                  scaled_text(scenario.evaluate_from.ns, kNsPerSecond), scenario.file)});
  scenario.duration = scenario.world.duration = duration;
}

fusion::StrategyKind strategy_of(const std::string& name) {
  for (const auto kind : {fusion::StrategyKind::kBuff, fusion::StrategyKind::kAdva})
    if (nodes::name_of(kind) == name) return kind;
  return fusion::StrategyKind::kTt;
}

}  // namespace

void add_node_set_options(CLI::App& command, NodeSetArguments& arguments) {
  command.add_option("scenario", arguments.scenario, "Scenario file, or a cluster file for the default scene")
      ->required();
  command
      .add_option("--strategy", arguments.strategy, "Fusion strategy, and with it the scenario's cluster (default: tt)")
      ->check(CLI::IsMember({"buff", "adva", "tt"}));
  command.add_option("--seed", arguments.seed, "Seed of every random stream, instead of the scenario's");
  command.add_option("--bus", arguments.bus,
                     "dds (default), or socketcan:IF[,IF] with the interfaces of channels A and B");
  command.add_option("--session", arguments.session,
                     "Name that all nodes of one drive share on dds, and no others (default: ttfusion; launch: its own)");
  command.add_flag("--virtual-time", arguments.virtual_time, "As fast as the processes can, instead of in real time");
  command.add_option("--time-scale", arguments.time_scale, "Stretch the schedule in real time, 0.1..1000");
  command.add_option("--duration", arguments.duration, "Seconds to drive, instead of the scenario's");
}

NodeSet read_node_set(const NodeSetArguments& arguments) {
  NodeSet set;
  set.file = arguments.scenario;
  set.strategy = strategy_of(arguments.strategy);
  set.bus = launch::Bus::parse(arguments.bus);
  set.session = arguments.session;
  set.virtual_time = arguments.virtual_time;
  if (arguments.time_scale)
    set.time_scale_ppm = decimal_option("--time-scale", *arguments.time_scale, kPpm, kTimeScales, "");
  if (set.virtual_time && arguments.time_scale)
    throw InputError({"command line", 0, "--time-scale", *arguments.time_scale,
                      "must not be given with --virtual-time, which has no pace"});
  if (set.virtual_time && set.bus.kind != launch::BusKind::kDds)
    throw InputError({"command line", 0, "--bus", arguments.bus,
                      "must be dds with --virtual-time: on CAN nobody can promise to be silent until an instant"});

  if (is_cluster_file(set.file)) {
    set.cluster = checked_cluster(set.file);
    set.scenario = default_scene(set.cluster);
  } else {
    set.scenario = nodes::load_scenario(set.file);
    set.cluster = checked_cluster(set.scenario.cluster_files[static_cast<std::size_t>(set.strategy)]);
  }
  if (nodes::is_recorded(set.cluster))
    throw InputError({set.file, 0, "clusters", set.cluster.file,
                      "must be a cluster with sensors: a recording is played by `ttfusion run --input`, in one process"});
  set.seed = arguments.seed ? seed_of(*arguments.seed) : set.scenario.seed;
  if (arguments.duration) set_duration(set.scenario, *arguments.duration);
  sim::check_fits(set.scenario, set.cluster, false);
  set.folder = arguments.out.empty() ? folder_of(set.scenario) + "/launch" : arguments.out;
  return set;
}

std::vector<std::string> NodeSet::options() const {
  std::vector<std::string> list{file,    "--strategy", std::string(nodes::name_of(strategy)),
                                "--seed", fmt::to_string(seed), "--bus", bus.text(), "--session", session,
                                "--duration", scaled_text(scenario.duration.ns, kNsPerSecond)};
  if (virtual_time)
    list.emplace_back("--virtual-time");
  else
    list.insert(list.end(), {"--time-scale", scaled_text(time_scale_ppm, kPpm)});
  list.insert(list.end(), {"--out", folder});
  return list;
}

NodeId node_of(const schedules::Cluster& cluster, const std::string& name) {
  if (const auto node = cluster.find_node(name)) return *node;
  std::vector<std::string> names;
  for (const schedules::Node& node : cluster.nodes) names.push_back(node.name);
  throw InputError(
      {"command line", 0, "NAME", name, fmt::format("must be a node of {}: {}", cluster.file, fmt::join(names, ", "))});
}

}  // namespace ttf::cli
