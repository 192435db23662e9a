#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/experiment/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "experiments/campaign/coverage.h"
#include "experiments/campaign/csv.h"

namespace ttf::cli::experiment {
namespace {

using experiments::campaign::CampaignBus;
using experiments::campaign::CampaignFile;
using experiments::campaign::Coverage;
using experiments::campaign::FaultResult;
using experiments::campaign::Story;
using experiments::campaign::Words;

constexpr std::size_t kShownHarms = 40;   // further harms are only in the results' table
constexpr std::uint64_t kShownActs = 12;  // in a replay, each kind of them

std::uint32_t fault_of(const std::string& text, const CampaignFile& campaign) {
  std::uint32_t fault = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), fault);
  if (error != std::errc{} || end != text.data() + text.size() || fault >= campaign.faults)
    throw InputError({"command line", 0, "--replay", text, fmt::format("must be 0..{}", campaign.faults - 1)});
  return fault;
}

// Prints the story in the order of time; events of one instant keep the order in which they became known.
void print(const Story& story, const Words& words) {
  std::vector<Story::Line> lines = story.lines();
  std::stable_sort(lines.begin(), lines.end(), [](const Story::Line& a, const Story::Line& b) { return a.at < b.at; });
  std::map<Story::Of, std::uint64_t> shown;
  for (const Story::Line& line : lines) {
    if (line.of != Story::Of::kOthers && ++shown[line.of] > kShownActs) continue;
    fmt::print("  {:>10.3f} ms  ", in_ms(line.at));
    if (!words.unit_beside_ms.empty())
      fmt::print("{} {:>6.2f}  ", words.unit_beside_ms, in_units_of(words.unit, line.at - TrueTime{}));
    fmt::print("{}\n", line.text);
  }
  const auto beyond = [&](Story::Of of) { return shown[of] > kShownActs ? shown[of] - kShownActs : 0; };
  if (const auto more = beyond(Story::Of::kFault)) fmt::print("  the fault acts {} more\n", counted(more, "time"));
  if (const auto more = beyond(Story::Of::kGuardians))
    fmt::print("  the guardians intervene {} more\n", counted(more, "time"));
  if (const auto more = beyond(Story::Of::kErrorFrames)) fmt::print("  {} more\n", counted(more, "error frame"));
}

int replay(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignBus& bus) {
  const std::uint32_t fault = fault_of(*options.replay, campaign);
  const experiments::campaign::DrawnFault drawn = bus.draw(fault);
  fmt::print("fault {}: {}\n", fault, experiments::campaign::fault_text(drawn, bus.cluster()));
  if (!bus.in_hypothesis(drawn.fault)) fmt::print("The fault is outside the fault hypothesis.\n");
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    fmt::print("\nvariant {}\n", campaign.variants[v].name);
    Story story;
    const experiments::campaign::FaultOutcome outcome = bus.run(v, drawn, fault, &story);
    print(story, bus.words());
    fmt::print("  {}\n", outcome.harms == 0 ? "no fault-free node is harmed"
                                            : "harm: " + experiments::campaign::harm_text(outcome, bus));
  }
  return 0;
}

std::string key_of(std::string_view words) {
  std::string key(words);
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

nlohmann::ordered_json to_json(const experiments::campaign::Spread& spread, const Words& words) {
  if (spread.count == 0) return nullptr;
  const auto in_unit = [&](std::int64_t ns) { return static_cast<double>(ns) / static_cast<double>(words.unit.ns); };
  return {{"count", spread.count},
          {fmt::format("median_{}", words.unit_name), in_unit(spread.median_ns)},
          {fmt::format("worst_{}", words.unit_name), in_unit(spread.worst_ns)}};
}

nlohmann::ordered_json to_json(const Coverage& coverage, const Words& words) {
  nlohmann::ordered_json json{{"variant", coverage.variant},
                              {key_of(words.trait), coverage.has_trait},
                              {"harmed_in_hypothesis", coverage.harmed_in_hypothesis}};
  for (const experiments::campaign::ClassCoverage& row : coverage.classes) {
    nlohmann::ordered_json one{{"class", faults::name_of(row.kind)},
                               {"in_hypothesis", row.in_hypothesis},
                               {"injected", row.injected},
                               {"activated", row.activated},
                               {"detected", row.detected}};
    for (std::size_t c = 0; c < words.checks.size(); ++c)
      one["detected_by"][std::string(words.checks[c])] = row.by_check[c];
    one["noticed_by_itself"] = row.by_itself;
    one["harmed"] = row.harmed;
    for (std::size_t h = 0; h < words.harms.size(); ++h) one["harmed_by"][std::string(words.harms[h])] = row.by_harm[h];
    one["fails_without_fault"] = row.without;
    one["to_detect"] = to_json(row.detect, words);
    one["to_passive"] = to_json(row.passive, words);
    one["to_" + key_of(words.halt)] = to_json(row.halt, words);
    one["to_" + key_of(words.reintegrate)] = to_json(row.reintegrate, words);
    json["classes"].push_back(std::move(one));
  }
  return json;
}

// Describes harm by faults that should be harmless.
std::string harms_text(const ExperimentOptions& options, const CampaignFile& campaign, const CampaignBus& bus,
                       const std::vector<FaultResult>& results) {
  std::string out;
  std::size_t count = 0;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v)
    for (const FaultResult& result : results) {
      if (result.outcomes[v].harms == 0 || !bus.is_harmless(v, result.drawn.fault) || ++count > kShownHarms) continue;
      out += fmt::format("fault {}: {}\n  {}\n  ttfusion experiment {} --replay {}{}\n", result.index,
                         experiments::campaign::fault_text(result.drawn, bus.cluster()),
                         experiments::campaign::harm_text(result.outcomes[v], bus), options.file, result.index,
                         options.seed ? fmt::format(" --seed {}", *options.seed) : "");
    }
  if (count > kShownHarms) out += fmt::format("and {} more, in results.csv\n", count - kShownHarms);
  return out;
}

std::vector<FaultResult> results_of(const ExperimentOptions& options, const CampaignFile& campaign,
                                    const CampaignBus& bus) {
  if (!options.merge.empty()) {
    std::vector<std::vector<FaultResult>> shards;
    for (const std::string& folder : options.merge) {
      const std::string path = folder + "/results.csv";
      shards.push_back(experiments::campaign::read_campaign_csv(campaign, bus, read_file(path), path));
    }
    return experiments::campaign::merged(campaign, std::move(shards));
  }
  const experiments::results::Shard shard = shard_of(options.shard);
  const unsigned jobs = options.jobs > 0 ? options.jobs : experiments::results::workers_here();
  const auto all = (static_cast<std::uint64_t>(campaign.faults) + shard.count - 1 - shard.part) / shard.count;
  fmt::print(stderr, "{}: {} in {}, {} ...\n", campaign.name, counted(all, "fault"),
             counted(campaign.variants.size(), "variant"), counted(jobs, "worker"));
  Progress progress("faults");
  return experiments::campaign::run_campaign(campaign, bus, shard, jobs,
                                             [&](std::uint64_t done) { progress(done, all, done); });
}

}  // namespace

int run_fault_campaign(const ExperimentOptions& options) {
  if (options.resume)
    throw InputError(
        {"command line", 0, "--resume", "", "is for sweeps: a campaign does not keep its trials one by one"});
  const CampaignFile campaign = experiments::campaign::read_campaign(file_with_seed(options.file, options.seed));
  const std::unique_ptr<const CampaignBus> bus = experiments::campaign::bus_of(campaign);
  if (options.replay) return replay(options, campaign, *bus);
  if (!options.out.empty()) create_folder(options.out);
  const std::vector<FaultResult> results = results_of(options, campaign, *bus);

  nlohmann::ordered_json json{{"campaign", campaign.name}, {"seed", campaign.seed}, {"faults", results.size()}};
  std::string text;
  std::uint64_t harmed = 0;
  bool outside = false;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const Coverage coverage = experiments::campaign::coverage_of(campaign, *bus, results, v);
    text += experiments::campaign::coverage_text(coverage, bus->words()) + '\n';
    json["variants"].push_back(to_json(coverage, bus->words()));
    harmed += coverage.harmed_unexpectedly;
    for (const auto& row : coverage.classes) outside |= !row.in_hypothesis;
  }
  if (outside) text += "* outside the fault hypothesis\n";
  const auto expectation = bus->expectation();
  const bool holds = !expectation || harmed <= static_cast<std::uint64_t>(expectation->most);
  if (expectation) {
    text +=
        fmt::format("expected: {}; found {}: {}\n", expectation->sentence, harmed, holds ? "holds" : "does not hold");
    json["expectation"] = {{std::string(expectation->key), expectation->most}, {"harmed", harmed}, {"holds", holds}};
  }
  text += harms_text(options, campaign, *bus, results);
  if (!options.out.empty()) {
    write_file(options.out + "/results.csv", experiments::campaign::campaign_csv(campaign, *bus, results));
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
