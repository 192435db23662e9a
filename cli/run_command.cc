#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/fault_tables.h"
#include "cli/output.h"
#include "cli/run_outputs.h"
#include "cli/startup_outputs.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "nodes/catalog.h"
#include "recording/log_writer.h"
#include "recording/recorded_input.h"
#include "recording/records/tee.h"
#include "schedules/checker.h"
#include "schedules/loader.h"

namespace ttf::cli {
namespace {

struct RunOptions {
  std::string scenario;
  std::string strategy;
  std::optional<std::string> seed;
  std::string input;
  std::string out;
  bool json = false;
  bool no_log = false;
  bool no_pictures = false;
};

std::string hex_hash(const std::string& text) {
  // FNV-1a, 64 bits: names the exact input a log was made from.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

schedules::Cluster checked_cluster(const std::string& file) {
  schedules::Cluster cluster = schedules::load_cluster(file);
  if (auto findings = schedules::check(cluster); !findings.empty()) throw InputError(std::move(findings));
  schedules::bind_ports(cluster, nodes::step_ports());
  return cluster;
}

// What --input gives: the observations, and what the manifest says of the file they came from. Its name goes without the
// folder, so that a log does not depend on where the file lay.
struct Recording {
  std::shared_ptr<const recording::RecordedInput> rows;
  std::string name, hash;
};

Recording read_recording(const std::string& path) {
  if (path.empty()) return {};
  const std::string text = read_file(path);
  return {std::make_shared<recording::RecordedInput>(recording::parse_laser_radar(text, path)),
          std::filesystem::path(path).filename().string(), hex_hash(text)};
}

recording::LogManifest manifest_of(const nodes::Scenario& scenario, const schedules::Cluster& cluster,
                                   fusion::StrategyKind strategy, std::uint64_t seed, const Recording& recording) {
  recording::LogManifest manifest;
  manifest.version = TTF_VERSION;
  manifest.seed = seed;
  manifest.scenario_name = scenario.name;
  manifest.cluster_name = cluster.name;
  manifest.strategy = nodes::name_of(strategy);
  manifest.cycle_ns = cluster.cycle().ns;
  manifest.bit_ps = cluster.flexray.gdBit_ps;
  manifest.hashes = {{"scenario", hex_hash(scenario.text)}, {"cluster", hex_hash(cluster.text)}};
  if (recording.rows) {
    manifest.recording_name = recording.name;
    manifest.hashes.emplace_back("recording", recording.hash);
  }
  for (const schedules::Node& node : cluster.nodes) {
    manifest.node_names.push_back(node.name);
    manifest.task_names.emplace_back();
    for (const schedules::Task& task : node.tasks) manifest.task_names.back().push_back(task.name);
  }
  for (const schedules::PduLayout& pdu : cluster.pdus) {
    manifest.pdu_names.push_back(pdu.name);
    manifest.pdu_sensors.push_back(pdu.sensor);
  }
  for (const schedules::Sensor& sensor : cluster.sensors) manifest.sensor_names.push_back(sensor.name);
  for (const schedules::CanBus& bus : cluster.can_buses) manifest.can_bus_names.push_back(bus.name);
  return manifest;
}

std::vector<fusion::StrategyKind> chosen(const std::string& name) {
  std::vector<fusion::StrategyKind> strategies;
  for (const auto kind : {fusion::StrategyKind::kBuff, fusion::StrategyKind::kAdva, fusion::StrategyKind::kTt})
    if (name.empty() || nodes::name_of(kind) == name) strategies.push_back(kind);
  return strategies;
}

StrategyResult run_strategy(const RunOptions& options, const nodes::Scenario& scenario, fusion::StrategyKind strategy,
                            std::uint64_t seed, const Recording& recording, const std::string& folder) {
  StrategyResult result;
  result.strategy = strategy;
  result.cluster = checked_cluster(scenario.cluster_files[static_cast<std::size_t>(strategy)]);
  experiments::DriveMeasures measures(sim::evaluation_start(scenario));
  experiments::StartupAccount startup(result.cluster.cycle());
  const nodes::FaultPlan plan = nodes::resolve(scenario.faults, result.cluster);
  experiments::FaultReport faults(result.cluster, plan, !scenario.startup.cold);
  std::vector<records::Sink*> sinks{&measures, &startup};
  if (!scenario.faults.empty()) sinks.push_back(&faults);
  std::unique_ptr<recording::LogWriter> log;
  if (!options.no_log) {
    result.log_path = fmt::format("{}/{}.mcap", folder, nodes::name_of(strategy));
    if (!options.input.empty()) refuse_overwriting(options.input, result.log_path, "--out");
    log = std::make_unique<recording::LogWriter>(result.log_path,
                                                 manifest_of(scenario, result.cluster, strategy, seed, recording));
    log->attach(std::filesystem::path(scenario.file).filename().string(), "application/yaml", scenario.text);
    log->attach(std::filesystem::path(result.cluster.file).filename().string(), "application/yaml",
                result.cluster.text);
    sinks.push_back(log.get());
  }
  records::Tee tee(sinks);
  const sim::DriveConfig config{&scenario, &result.cluster, strategy, seed, 0, recording.rows};
  result.outcome = sim::run_drive(config, tee);
  result.summary = measures.finish();
  result.startup = startup.nodes();
  faults.finish(sim::kFirstCycle + scenario.duration);
  result.faults = faults.findings();
  result.fault_free = fault_free_nodes(result.faults, plan, result.cluster);
  if (log) {
    log->close();
    result.content_hash = log->content_hash_text();
  }
  return result;
}

// The same rule as for a scenario's seed, and decimal digits only.
std::uint64_t seed_of(const std::string& text) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size() || seed > kMost)
    throw InputError({"command line", 0, "--seed", text, fmt::format("must be a whole number 0..{}", kMost)});
  return seed;
}

// Where results go without --out; a name that leads elsewhere is no name.
std::string folder_of(const nodes::Scenario& scenario) {
  if (scenario.name.empty() || scenario.name.find('/') != std::string::npos || scenario.name.front() == '.')
    throw InputError({scenario.file, 0, "name", scenario.name, "must name a folder under out/, or --out be given"});
  return "out/" + scenario.name;
}

int run_scenario(const RunOptions& options) {
  const nodes::Scenario scenario = nodes::load_scenario(options.scenario);
  const std::uint64_t seed = options.seed ? seed_of(*options.seed) : scenario.seed;
  const Recording recording = read_recording(options.input);
  const std::string folder = options.out.empty() ? folder_of(scenario) : options.out;
  // Before anything is simulated or an earlier run's log is written over.
  for (const fusion::StrategyKind strategy : chosen(options.strategy))
    sim::check_fits(scenario, checked_cluster(scenario.cluster_files[static_cast<std::size_t>(strategy)]),
                    recording.rows != nullptr);
  create_folder(folder);

  std::vector<StrategyResult> results;
  for (const fusion::StrategyKind strategy : chosen(options.strategy)) {
    fmt::print(stderr, "{}: {:g} s with {} ...\n", scenario.name, scenario.duration.seconds(), nodes::name_of(strategy));
    results.push_back(run_strategy(options, scenario, strategy, seed, recording, folder));
  }
  if (!options.no_pictures && !options.no_log) write_pictures(scenario, results, folder);
  const nlohmann::ordered_json json = to_json(scenario, seed, results);
  write_file(folder + "/summary.json", json.dump(2) + '\n');
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}\n{}{}", scenario.description, startup_text(results, scenario.startup.cold),
               comparison_table(results));
    if (!scenario.faults.empty())
      for (const StrategyResult& result : results)
        fmt::print("\n{}", faults_text(nodes::name_of(result.strategy), result.faults, result.fault_free,
                                     result.cluster));
  }
  std::fflush(stdout);   // both may go to one file
  fmt::print(stderr, "written to {}\n", folder);
  return 0;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "One drive in virtual time: log, summary table and pictures");
  command->footer("Example: ttfusion run scenarios/paper_scenario1.yaml --seed 7 --out out/drive");
  command->add_option("scenario", options->scenario, "Scenario file")->required();
  command->add_option("--strategy", options->strategy, "Only one strategy; all three otherwise")
      ->check(CLI::IsMember({"buff", "adva", "tt"}));
  command->add_option("--seed", options->seed, "Seed of every random stream, instead of the scenario's");
  command->add_option("--input", options->input, "Recorded observations in place of the sensor models");
  command->add_option("--out", options->out, "Folder for logs and pictures (default: out/<scenario>)");
  command->add_flag("--json", options->json, "Summary as JSON on standard output");
  command->add_flag("--no-log", options->no_log, "Write no logs (and so no pictures)");
  command->add_flag("--no-pictures", options->no_pictures, "Write logs only");
  command->callback([options, &action] { action = [options] { return run_scenario(*options); }; });
}

}  // namespace ttf::cli
