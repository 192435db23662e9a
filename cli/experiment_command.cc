#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/replay_story.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "experiments/campaign_csv.h"
#include "experiments/coverage.h"

namespace ttf::cli {
namespace {

using experiments::CampaignClusters;
using experiments::CampaignFile;
using experiments::Coverage;
using experiments::FaultResult;

constexpr std::size_t kShownHarms = 40;   // the others are in the results' table

struct ExperimentOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> merge;
  std::optional<std::uint32_t> replay;
  unsigned jobs = 0;
  bool json = false;
};

experiments::Shard shard_of(const std::string& text) {
  experiments::Shard shard;
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

// Faults done, and how long the others will take; on a terminal only.
class Progress {
 public:
  explicit Progress(std::uint64_t all) : all_(all), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) fmt::print(stderr, "\r{:60}\r", "");
  }
  void operator()(std::uint64_t done) const {
    if (!shown_ || done == 0) return;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began_;
    const double left = passed.count() * static_cast<double>(all_ - done) / static_cast<double>(done);
    fmt::print(stderr, "\r{} of {} faults, {:.0f} s to go ", done, all_, left);
    std::fflush(stderr);
  }

 private:
  std::uint64_t all_;
  bool shown_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

int replay(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignClusters& clusters) {
  if (*options.replay >= campaign.faults)
    throw InputError({"command line", 0, "--replay", fmt::to_string(*options.replay),
                      fmt::format("must be 0..{}", campaign.faults - 1)});
  const experiments::DrawnFault drawn = experiments::draw_fault(campaign, clusters.base, *options.replay);
  fmt::print("fault {}: {}\n", *options.replay, experiments::fault_text(drawn, clusters.base));
  if (!experiments::in_hypothesis(drawn.fault)) fmt::print("It is outside of the fault hypothesis.\n");
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    fmt::print("\nvariant {}\n", campaign.variants[v].name);
    ReplayStory story(clusters.variants[v]);
    const experiments::FaultOutcome outcome =
        experiments::run_trial(campaign, clusters.variants[v], drawn, *options.replay, &story);
    story.finish();
    fmt::print("  {}\n", outcome.harms == 0 ? "no fault-free node is harmed"
                                            : "harm: " + experiments::harm_text(outcome, clusters.variants[v]));
  }
  return 0;
}

nlohmann::ordered_json to_json(const experiments::Spread& spread, Duration cycle) {
  if (spread.count == 0) return nullptr;
  const auto cycles = [&](std::int64_t ns) { return static_cast<double>(ns) / static_cast<double>(cycle.ns); };
  return {
      {"count", spread.count}, {"median_cycles", cycles(spread.median_ns)}, {"worst_cycles", cycles(spread.worst_ns)}};
}

nlohmann::ordered_json to_json(const Coverage& coverage, Duration cycle) {
  nlohmann::ordered_json json{{"variant", coverage.variant},
                              {"guardian_and_two_channels", coverage.guarded},
                              {"harmed_in_hypothesis", coverage.harmed_in_hypothesis}};
  for (const experiments::ClassCoverage& row : coverage.classes) {
    nlohmann::ordered_json one{{"class", nodes::name_of(row.kind)}, {"in_hypothesis", row.in_hypothesis},
                               {"injected", row.injected},          {"activated", row.activated},
                               {"detected", row.detected}};
    for (const experiments::Check check : experiments::kAllChecks)
      one["detected_by"][std::string(name_of(check))] = row.by_check[static_cast<std::size_t>(check)];
    one["noticed_by_itself"] = row.by_itself;
    one["harmed"] = row.harmed;
    for (const experiments::Harm harm : experiments::kAllHarms)
      one["harmed_by"][std::string(name_of(harm))] = row.by_harm[static_cast<std::size_t>(harm)];
    one["fails_without_fault"] = row.without;
    one["to_detect"] = to_json(row.detect, cycle);
    one["to_passive"] = to_json(row.passive, cycle);
    one["to_halt"] = to_json(row.halt, cycle);
    one["to_reintegrate"] = to_json(row.reintegrate, cycle);
    json["classes"].push_back(std::move(one));
  }
  return json;
}

// What harmed a fault-free node although guardians and two channels were there.
std::string harms_text(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignClusters& clusters,
                       const std::vector<FaultResult>& results) {
  std::string out;
  std::size_t count = 0;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    if (!campaign.variants[v].guarded()) continue;
    for (const FaultResult& result : results) {
      if (result.outcomes[v].harms == 0 || !experiments::in_hypothesis(result.drawn.fault) || ++count > kShownHarms)
        continue;
      out += fmt::format("fault {}: {}\n  {}\n  ttfusion experiment {} --replay {}\n", result.index,
                         experiments::fault_text(result.drawn, clusters.base),
                         experiments::harm_text(result.outcomes[v], clusters.variants[v]), options.file, result.index);
    }
  }
  if (count > kShownHarms) out += fmt::format("and {} more, in results.csv\n", count - kShownHarms);
  return out;
}

std::vector<FaultResult> results_of(const ExperimentOptions& options, const CampaignFile& campaign,
                                    const CampaignClusters& clusters) {
  if (!options.merge.empty()) {
    std::vector<std::vector<FaultResult>> shards;
    for (const std::string& folder : options.merge) {
      const std::string path = folder + "/results.csv";
      shards.push_back(experiments::read_campaign_csv(campaign, clusters, read_file(path), path));
    }
    return experiments::merged(campaign, std::move(shards));
  }
  const experiments::Shard shard = shard_of(options.shard);
  const unsigned jobs = options.jobs > 0 ? options.jobs : experiments::workers_here();
  const auto all = (static_cast<std::uint64_t>(campaign.faults) + shard.count - 1 - shard.part) / shard.count;
  fmt::print(stderr, "{}: {} in {}, {} ...\n", campaign.name, counted(all, "fault"),
             counted(campaign.variants.size(), "variant"), counted(jobs, "worker"));
  const Progress progress(all);
  return experiments::run_campaign(campaign, clusters, shard, jobs, [&](std::uint64_t done) { progress(done); });
}

int run_experiment(const ExperimentOptions& options) {
  const CampaignFile campaign = experiments::load_campaign(options.file);
  const CampaignClusters clusters(campaign);
  if (options.replay) return replay(options, campaign, clusters);
  if (!options.out.empty()) create_folder(options.out);
  const std::vector<FaultResult> results = results_of(options, campaign, clusters);

  const Duration cycle = clusters.base.cycle();
  nlohmann::ordered_json json{{"campaign", campaign.name}, {"seed", campaign.seed}, {"faults", results.size()}};
  std::string text;
  std::uint64_t harmed = 0;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const Coverage coverage = experiments::coverage_of(campaign, results, v);
    text += experiments::coverage_text(coverage, cycle) + '\n';
    json["variants"].push_back(to_json(coverage, cycle));
    if (coverage.guarded) harmed += coverage.harmed_in_hypothesis;
  }
  text += "* outside of the fault hypothesis\n";
  const bool holds = !campaign.expected_harmed || harmed <= static_cast<std::uint64_t>(*campaign.expected_harmed);
  if (campaign.expected_harmed) {
    text += fmt::format("expected: at most {} of the hypothesis {} in spite of guardian and two channels; {}: {}\n",
                        counted(static_cast<std::uint64_t>(*campaign.expected_harmed), "fault"),
                        *campaign.expected_harmed == 1 ? "harms" : "harm", harmed, holds ? "holds" : "does not hold");
    json["expectation"] = {{"harmed_with_guardian", *campaign.expected_harmed}, {"harmed", harmed}, {"holds", holds}};
  }
  text += harms_text(options, campaign, clusters, results);
  if (!options.out.empty()) {
    write_file(options.out + "/results.csv", experiments::campaign_csv(campaign, clusters, results));
    write_file(options.out + "/coverage.txt", text);
    write_file(options.out + "/coverage.json", json.dump(2) + '\n');
    fmt::print(stderr, "written to {}\n", options.out);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else
    fmt::print("{}", text);
  return holds ? 0 : 1;
}

}  // namespace

void add_experiment(CLI::App& app, Action& action) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand("experiment", "A campaign of single faults: who notices them, whom they harm");
  command->footer(
      "Examples: ttfusion experiment experiments/fault_campaign.yaml --out out/campaign\n"
      "          ttfusion experiment experiments/fault_campaign.yaml --replay 17\n"
      "          ttfusion experiment FILE --shard 1/2 --out a; ttfusion experiment FILE --shard 2/2 --out b;\n"
      "          ttfusion experiment FILE --merge a b");
  command->add_option("file", options->file, "Experiment file")->required();
  command->add_option("--jobs", options->jobs, "Workers (default: one per processor)")->check(CLI::Range(1u, 1024u));
  auto* shard = command->add_option("--shard", options->shard, "i/n: every n-th fault only, from the i-th on");
  auto* merge = command->add_option("--merge", options->merge, "Folders of all shards, whose results are put together");
  auto* replay = command->add_option("--replay", options->replay, "One fault alone, with what happens in words");
  command->add_option("--out", options->out, "Folder for results.csv, coverage.txt and coverage.json");
  command->add_flag("--json", options->json, "Coverage as JSON on standard output");
  merge->excludes(shard);
  replay->excludes(shard)->excludes(merge);
  command->callback([options, &action] { action = [options] { return run_experiment(*options); }; });
}

}  // namespace ttf::cli
