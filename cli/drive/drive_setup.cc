#include "cli/drive/drive_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "cli/decimal_option.h"
#include "cli/drive/fault_tables.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "core/hash.h"
#include "experiments/sweep/driving.h"
#include "recording/mcap/bytes.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "schedules/file/loader.h"
#include "sim/drives/drive.h"
#include "sim/drives/seeds.h"
#include "sim/drives/step_catalog.h"

namespace ttf::cli::drive {

schedules::model::Cluster checked_cluster(const std::string& file) {
  schedules::model::Cluster cluster = schedules::file::load_cluster(file);
  if (auto findings = schedules::check::check(cluster); !findings.empty()) throw InputError(std::move(findings));
  sim::drives::check_described(cluster);
  sim::drives::check_steps(cluster);
  return cluster;
}

schedules::model::Cluster checked_cluster(const sim::drives::Scenario& scenario,
                                          fusion::strategies::StrategyKind strategy) {
  const std::string& file = scenario.cluster_files[static_cast<std::size_t>(strategy)];
  (void)read_named_file(file, sim::drives::cluster_entry(scenario, strategy), "a cluster file");
  return checked_cluster(file);
}

Recording read_recording(const std::string& path) {
  if (path.empty()) return {};
  const std::string text = read_file(path);
  try {
    return {std::make_shared<recording::rows::RecordedInput>(recording::rows::parse_laser_radar(text, path)),
            std::filesystem::path(path).filename().string(), hex_hash(text)};
  } catch (const InputError&) {
    refuse_any_kind(path, "a recording");
    throw;
  }
}

std::shared_ptr<const recording::osi::TruthTrace> read_truth(const std::string& path) {
  if (path.empty()) return nullptr;
  const std::string bytes = read_file(path);
  try {
    return std::make_shared<recording::osi::TruthTrace>(recording::osi::parse_truth_trace(bytes, path));
  } catch (const InputError&) {
    if (!bytes.starts_with(recording::mcap::kMcapMagic)) refuse_any_kind(path, "an OSI trace");
    throw;
  }
}

recording::log::LogManifest manifest_of(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster,
                                        fusion::strategies::StrategyKind strategy, std::uint64_t seed,
                                        const Recording& recording, const nodes::foreign::StepFolder* steps,
                                        const std::vector<NodeId>& externals) {
  recording::log::LogManifest manifest;
  manifest.version = TTF_VERSION;
  manifest.seed = seed;
  manifest.scenario_name = scenario.name;
  manifest.cluster_name = cluster.name;
  manifest.strategy = name_of(strategy);
  manifest.cycle_ns = cluster.cycle().ns;
  manifest.cycles = cycles_per_round(cluster.flexray);
  manifest.bit_ps = cluster.flexray.gdBit_ps;
  manifest.hashes = {{"scenario", hex_hash(scenario.text)}, {"cluster", hex_hash(cluster.text)}};
  if (recording.rows) {
    manifest.recording_name = recording.name;
    manifest.hashes.emplace_back("recording", recording.hash);
  }
  if (scenario.truth) {
    manifest.truth_name = std::filesystem::path(scenario.truth->name).filename().string();
    manifest.hashes.emplace_back("truth", scenario.truth->hash);
  }
  for (auto& library : nodes::foreign::library_hashes(cluster, steps, externals))
    manifest.hashes.push_back(std::move(library));
  for (const schedules::model::Node& node : cluster.nodes) {
    manifest.node_names.push_back(node.name);
    manifest.task_names.emplace_back();
    for (const schedules::model::Task& task : node.tasks) manifest.task_names.back().push_back(task.name);
  }
  for (const schedules::model::PduLayout& pdu : cluster.pdus) {
    manifest.pdu_names.push_back(pdu.name);
    manifest.pdu_sensors.push_back(pdu.sensor);
  }
  for (const schedules::model::Sensor& sensor : cluster.sensors) manifest.sensor_names.push_back(sensor.name);
  manifest.sensor_styles = sensors::kinds::sensor_styles(scenario.sensors, cluster);
  for (const schedules::model::CanBus& bus : cluster.can_buses) manifest.can_bus_names.push_back(bus.name);
  return manifest;
}

std::vector<std::string> strategy_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : fusion::strategies::kStrategyNames) names.emplace_back(name);
  return names;
}

fusion::strategies::StrategyKind strategy_of(const std::string& name) {
  if (const auto kind = fusion::strategies::strategy_named(name)) return *kind;
  throw InputError(
      {"command line", 0, "--strategy", name, fmt::format("must be one of {}", fmt::join(strategy_names(), ", "))});
}

std::vector<fusion::strategies::StrategyKind> chosen(const std::string& name) {
  if (!name.empty()) return {strategy_of(name)};
  return {fusion::strategies::kAllStrategies.begin(), fusion::strategies::kAllStrategies.end()};
}

std::unique_ptr<recording::log::LogWriter> begin_log(const std::string& path,
                                                     const recording::log::LogManifest& manifest,
                                                     const sim::drives::Scenario& scenario,
                                                     const schedules::model::Cluster& cluster) {
  auto log = std::make_unique<recording::log::LogWriter>(path, manifest);
  log->attach(std::filesystem::path(scenario.file).filename().string(), "application/yaml", scenario.text);
  log->attach(std::filesystem::path(cluster.file).filename().string(), "application/yaml", cluster.text);
  return log;
}

std::uint64_t seed_of(const std::string& text) {
  const auto [least, most] = sim::drives::kSeeds;
  std::int64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size() || !sim::drives::kSeeds.contains(seed))
    throw InputError({"command line", 0, "--seed", text, fmt::format("must be a whole number {}..{}", least, most)});
  return static_cast<std::uint64_t>(seed);
}

void set_duration(sim::drives::Scenario& scenario, const std::string& name, const std::string& text) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  constexpr Duration kShortest = Duration::milliseconds(100);  // same as in a scenario
  const std::string unit =
      fmt::format(" s ({} is evaluated from {} s on)", name, scaled_text(scenario.evaluate_from.ns, kNsPerSecond));
  const Range<std::int64_t> allowed{std::max(kShortest, scenario.evaluate_from).ns, kLongestDrive.ns};
  scenario.duration = scenario.world.duration =
      Duration{decimal_option("--duration", text, kNsPerSecond, allowed, unit)};
}

std::string named_folder(const sim::drives::Scenario& scenario) {
  if (scenario.name.empty() || scenario.name.find('/') != std::string::npos || scenario.name.front() == '.')
    throw InputError({scenario.file, 0, "name", scenario.name, "must name a folder under out/; give --out otherwise"});
  return scenario.name;
}

std::string folder_of(const sim::drives::Scenario& scenario) { return "out/" + named_folder(scenario); }

DriveJudge::DriveJudge(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster,
                       fusion::strategies::StrategyKind strategy, std::optional<TrueTime> until)
    : scenario_(scenario), cluster_(cluster), plan_(faults::resolve(scenario.faults, cluster)),
      measures_(sim::drives::evaluation_start(scenario), evaluation::accuracy::kGate_m, until, scenario.cut_off),
      stages_(schedules::analysis::measurement_ages(cluster), strategy == fusion::strategies::StrategyKind::kBuff,
              sim::drives::evaluation_start(scenario)),
      startup_(cluster.cycle()), faults_(cluster, plan_, !scenario.startup.cold) {
  if (scenario.world.ego && scenario.world.ego->actuator) {
    driving_.emplace(experiments::sweep::driving_config(scenario, cluster), sim::drives::evaluation_start(scenario));
    measures_.end_with([this] { return driving_->collided_at(); });
  }
}

std::vector<recording::records::Sink*> DriveJudge::sinks() {
  std::vector<recording::records::Sink*> sinks{&measures_, &stages_, &startup_};
  if (driving_) sinks.push_back(&*driving_);
  if (!scenario_.faults.empty()) sinks.push_back(&faults_);
  return sinks;
}

void DriveJudge::finish(StrategyResult& result) {
  result.summary = measures_.finish();
  result.stages = stages_.finish();
  result.startup = startup_.nodes();
  if (driving_) result.driving = driving_->finish();
  faults_.finish(sim::engine::kFirstCycle + scenario_.duration);
  result.faults = faults_.findings();
  result.fault_free = fault_free_nodes(result.faults, plan_, cluster_);
}

}  // namespace ttf::cli::drive
