#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/experiment/options.h"
#include "cli/experiment/replay_story.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "experiments/campaign/coverage.h"
#include "experiments/campaign/csv.h"

namespace ttf::cli::experiment {
namespace {

using experiments::campaign::CampaignClusters;
using experiments::campaign::CampaignFile;
using experiments::campaign::Coverage;
using experiments::campaign::FaultResult;

constexpr std::size_t kShownHarms = 40;  // further harms are only in the results' table

std::uint32_t fault_of(const std::string& text, const CampaignFile& campaign) {
  std::uint32_t fault = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), fault);
  if (error != std::errc{} || end != text.data() + text.size() || fault >= campaign.faults)
    throw InputError({"command line", 0, "--replay", text, fmt::format("must be 0..{}", campaign.faults - 1)});
  return fault;
}

int replay(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignClusters& clusters) {
  const std::uint32_t fault = fault_of(*options.replay, campaign);
  const experiments::campaign::DrawnFault drawn = experiments::campaign::draw_fault(campaign, clusters.base, fault);
  fmt::print("fault {}: {}\n", fault, experiments::campaign::fault_text(drawn, clusters.base));
  if (!experiments::campaign::in_hypothesis(drawn.fault)) fmt::print("The fault is outside the fault hypothesis.\n");
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    fmt::print("\nvariant {}\n", campaign.variants[v].name);
    ReplayStory story(clusters.variants[v]);
    const experiments::campaign::FaultOutcome outcome =
        experiments::campaign::run_trial(campaign, clusters.variants[v], drawn, fault, &story);
    story.finish();
    fmt::print("  {}\n", outcome.harms == 0
                             ? "no fault-free node is harmed"
                             : "harm: " + experiments::campaign::harm_text(outcome, clusters.variants[v]));
  }
  return 0;
}

nlohmann::ordered_json to_json(const experiments::campaign::Spread& spread, Duration cycle) {
  if (spread.count == 0) return nullptr;
  const auto cycles = [&](std::int64_t ns) { return static_cast<double>(ns) / static_cast<double>(cycle.ns); };
  return {
      {"count", spread.count}, {"median_cycles", cycles(spread.median_ns)}, {"worst_cycles", cycles(spread.worst_ns)}};
}

nlohmann::ordered_json to_json(const Coverage& coverage, Duration cycle) {
  nlohmann::ordered_json json{{"variant", coverage.variant},
                              {"guardian_and_two_channels", coverage.guarded},
                              {"harmed_in_hypothesis", coverage.harmed_in_hypothesis}};
  for (const experiments::campaign::ClassCoverage& row : coverage.classes) {
    nlohmann::ordered_json one{{"class", faults::name_of(row.kind)},
                               {"in_hypothesis", row.in_hypothesis},
                               {"injected", row.injected},
                               {"activated", row.activated},
                               {"detected", row.detected}};
    for (const evaluation::faults::Check check : evaluation::faults::kAllChecks)
      one["detected_by"][std::string(name_of(check))] = row.by_check[static_cast<std::size_t>(check)];
    one["noticed_by_itself"] = row.by_itself;
    one["harmed"] = row.harmed;
    for (const evaluation::faults::Harm harm : evaluation::faults::kAllHarms)
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

// Describes harm to fault-free nodes despite guardians and two channels.
std::string harms_text(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignClusters& clusters,
                       const std::vector<FaultResult>& results) {
  std::string out;
  std::size_t count = 0;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    if (!campaign.variants[v].guarded()) continue;
    for (const FaultResult& result : results) {
      if (result.outcomes[v].harms == 0 || !experiments::campaign::in_hypothesis(result.drawn.fault) ||
          ++count > kShownHarms)
        continue;
      out += fmt::format("fault {}: {}\n  {}\n  ttfusion experiment {} --replay {}\n", result.index,
                         experiments::campaign::fault_text(result.drawn, clusters.base),
                         experiments::campaign::harm_text(result.outcomes[v], clusters.variants[v]), options.file,
                         result.index);
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
      shards.push_back(experiments::campaign::read_campaign_csv(campaign, clusters, read_file(path), path));
    }
    return experiments::campaign::merged(campaign, std::move(shards));
  }
  const experiments::results::Shard shard = shard_of(options.shard);
  const unsigned jobs = options.jobs > 0 ? options.jobs : experiments::results::workers_here();
  const auto all = (static_cast<std::uint64_t>(campaign.faults) + shard.count - 1 - shard.part) / shard.count;
  fmt::print(stderr, "{}: {} in {}, {} ...\n", campaign.name, counted(all, "fault"),
             counted(campaign.variants.size(), "variant"), counted(jobs, "worker"));
  const Progress progress("faults");
  return experiments::campaign::run_campaign(campaign, clusters, shard, jobs,
                                             [&](std::uint64_t done) { progress(done, all, done); });
}

}  // namespace

int run_fault_campaign(const ExperimentOptions& options) {
  if (options.resume)
    throw InputError(
        {"command line", 0, "--resume", "", "is for sweeps: a campaign does not keep its trials one by one"});
  const CampaignFile campaign = experiments::campaign::load_campaign(options.file);
  const CampaignClusters clusters(campaign);
  if (options.replay) return replay(options, campaign, clusters);
  if (!options.out.empty()) create_folder(options.out);
  const std::vector<FaultResult> results = results_of(options, campaign, clusters);

  const Duration cycle = clusters.base.cycle();
  nlohmann::ordered_json json{{"campaign", campaign.name}, {"seed", campaign.seed}, {"faults", results.size()}};
  std::string text;
  std::uint64_t harmed = 0;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const Coverage coverage = experiments::campaign::coverage_of(campaign, results, v);
    text += experiments::campaign::coverage_text(coverage, cycle) + '\n';
    json["variants"].push_back(to_json(coverage, cycle));
    if (coverage.guarded) harmed += coverage.harmed_in_hypothesis;
  }
  text += "* outside the fault hypothesis\n";
  const bool holds = !campaign.expected_harmed || harmed <= static_cast<std::uint64_t>(*campaign.expected_harmed);
  if (campaign.expected_harmed) {
    text +=
        fmt::format("expected: at most {} of the hypothesis {} harm with guardian and both channels; found {}: {}\n",
                    counted(static_cast<std::uint64_t>(*campaign.expected_harmed), "fault"),
                    *campaign.expected_harmed == 1 ? "does" : "do", harmed, holds ? "holds" : "does not hold");
    json["expectation"] = {{"harmed_with_guardian", *campaign.expected_harmed}, {"harmed", harmed}, {"holds", holds}};
  }
  text += harms_text(options, campaign, clusters, results);
  if (!options.out.empty()) {
    write_file(options.out + "/results.csv", experiments::campaign::campaign_csv(campaign, clusters, results));
    write_file(options.out + "/coverage.txt", text);
    write_file(options.out + "/coverage.json", json.dump(2) + '\n');
    say_written(options.out);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else
    fmt::print("{}", text);
  return holds ? 0 : 1;
}

}  // namespace ttf::cli::experiment
