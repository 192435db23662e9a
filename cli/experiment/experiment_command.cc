#include <fmt/format.h>
#include <malloc.h>

#include <charconv>
#include <memory>
#include <string>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/experiment/options.h"
#include "cli/shipped.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "core/yaml_edit.h"
#include "experiments/sweep/file.h"
#include "sim/drives/seeds.h"

namespace ttf::cli::experiment {

experiments::results::Shard shard_of(const std::string& text) {
  experiments::results::Shard shard;
  if (text.empty()) return shard;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.part);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, shard.count);
    if (second.ec == std::errc{} && second.ptr == end && shard.part >= 1 && shard.part <= shard.count) {
      --shard.part;
      return shard;
    }
  }
  throw InputError({"command line", 0, "--shard", text, "must be i/n with i from 1 to n"});
}

ExperimentKind kind_of(const ExperimentOptions& options) {
  const StrictYaml yaml = load_of_kind(options.file, FileKind::kExperiment);
  Findings none;
  YamlMap root = yaml.root(none);
  const std::string kind = root.text_or("kind", "");
  if (kind == "fault_campaign") return ExperimentKind::kFaultCampaign;
  if (kind == "sweep") return ExperimentKind::kSweep;
  throw InputError({options.file, root.line("kind"), "kind", kind, "must be sweep or fault_campaign"});
}

StrictYaml file_with_seed(const std::string& path, std::optional<std::uint64_t> seed) {
  StrictYaml yaml = load_of_kind(path, FileKind::kExperiment);
  if (!seed) return yaml;
  Findings findings;
  YamlMap root = yaml.root(findings);
  const std::int64_t files = root.integer("seed", sim::drives::kSeeds);
  // The file's own mistake is left to its loader. Its own seed changes no byte.
  if (!findings.empty() || files == static_cast<std::int64_t>(*seed)) return yaml;
  return StrictYaml::parse(with_value(yaml.text(), yaml.name(), "seed", std::to_string(*seed)), yaml.name());
}

namespace {

// The next drive takes the memory that a drive frees. By default the C library returns that memory to the
// system each time, which interrupts all workers.
void keep_freed_memory() {
  constexpr int kMegabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 16 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 32 * kMegabyte);
}

int run_experiment(const ExperimentOptions& options) {
  if (!options.truth.empty())
    throw InputError(
        {"command line", 0, "--truth", options.truth,
         "is for `ttfusion run`, `launch` and `node`: an experiment draws the world of each replication, and "
         "a trace is one world"});
  keep_freed_memory();
  experiments::mpi::Ranks ranks;
  if (ranks.size() > 1) return run_on_ranks(options, ranks);
  if (kind_of(options) == ExperimentKind::kFaultCampaign) {
    if (options.replications > 0)
      throw InputError({"command line", 0, "--replications", std::to_string(options.replications),
                        "is for sweeps: a campaign injects each fault once"});
    if (options.steps.folder)
      throw InputError(
          {"command line", 0, "--steps", *options.steps.folder, "is for sweeps: a campaign runs no steps"});
    return run_fault_campaign(options);
  }
  return run_sweep_experiment(options, ranks);
}

}  // namespace

void add_experiment(CLI::App& app, Action& action) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "experiment", "Many drives and their answer: a sweep over paradigms and axes, or a campaign of single faults");
  command->footer(
      "Examples: ttfusion experiment experiments/process_noise.yaml --out out/noise\n"
      "          ttfusion experiment experiments/process_noise.yaml --out out/noise --resume\n"
      "          ttfusion experiment experiments/process_noise.yaml --replications 20 --out out/quick\n"
      "          ttfusion experiment experiments/process_noise.yaml --seed 2 --out out/noise_2\n"
      "          ttfusion experiment experiments/process_noise.yaml --replay 3/tt/17 --out out/one\n"
      "          ttfusion experiment experiments/fault_campaign.yaml --replay 17\n"
      "          ttfusion experiment experiments/process_noise.yaml --shard 1/2 --out out/first\n"
      "          ttfusion experiment experiments/process_noise.yaml --shard 2/2 --out out/second\n"
      "          ttfusion experiment experiments/process_noise.yaml --merge out/first out/second --out out/both\n"
      "          mpirun -n 8 ttfusion experiment experiments/process_noise.yaml --out out/all");
  command->add_option("file", options->file, "Experiment file, or a shipped one's name")->required();
  command->add_option("--jobs", options->jobs, "Workers (default: one per processor)")->check(whole_number({1, 1024}));
  command->add_option("--replications", options->replications, "Replications of every point, instead of the file's")
      ->check(whole_number({1, experiments::sweep::kMostReplications}));
  command->add_option("--seed", options->seed, "Seed of every random stream, instead of the file's")
      ->check(whole_number(sim::drives::kSeeds));
  auto* shard =
      command->add_option("--shard", options->shard, "i/n: every n-th fault or replication only, from the i-th on");
  auto* merge = command->add_option("--merge", options->merge, "Folders of all shards, to merge their results");
  auto* replay =
      command->add_option("--replay", options->replay, "One fault alone, or one run as point/paradigm/replication");
  auto* resume = command->add_flag("--resume", options->resume, "Continue the results that are in --out");
  command->add_option("-o,--out", options->out, "Folder for results (a sweep's default: out/<name>)")->check(named());
  command->add_option("--truth", options->truth, "Refused: a trace is for `ttfusion run`, `launch` and `node`")
      ->group("");
  drive::add_step_options(*command, options->steps);
  auto* json = command->add_flag("--json", options->json, "The answer as JSON on standard output");
  merge->excludes(shard)->excludes(resume);
  replay->excludes(shard)->excludes(merge)->excludes(resume)->excludes(json);
  command->callback([options, &action] {
    action = [options] {
      options->file = file_named(options->file, {kExperiments});
      return run_experiment(*options);
    };
  });
}

}  // namespace ttf::cli::experiment
