#include "experiments/campaign/file.h"

#include <algorithm>
#include <filesystem>

#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "schedules/file/loader.h"
#include "sim/drives/seeds.h"

namespace ttf::experiments::campaign {
namespace {

using schedules::model::Channels;
using schedules::model::Topology;
using sim::medium::CanRecovery;

constexpr std::int64_t kMostFaults = 100'000'000, kMostWeight = 1'000'000, kMostCycles = 10'000;
constexpr Range<Duration> kTrials{Duration::milliseconds(10), Duration::milliseconds(10'000)};
constexpr Range<Duration> kRestarts{Duration::microseconds(1), Duration::milliseconds(10'000)};

void read_wiring(Variant& variant, YamlMap& yaml) {
  variant.topology = yaml.choice<Topology>("topology", {{"bus", Topology::kBus}, {"star", Topology::kStar}});
  variant.guardian = yaml.boolean("guardian");
  variant.channels = yaml.choice<Channels>("channels", {{"AB", Channels::kAB}, {"A", Channels::kA}});
  if (variant.guardian && variant.topology != Topology::kStar) yaml.fail("guardian", "needs topology: star");
}

void read_recovery(Variant& variant, YamlMap& yaml) {
  variant.recovery = yaml.choice<CanRecovery>(
      "recovery",
      {{"automatic", CanRecovery::kAutomatic}, {"host", CanRecovery::kByHost}, {"never", CanRecovery::kNever}});
  if (variant.recovery == CanRecovery::kByHost) variant.restart_after = yaml.duration("restart_after", kRestarts);
}

// A variant with `recovery` is one of a CAN.
Variant read_variant(const std::string& name, YamlMap& yaml, bool on_can) {
  Variant variant;
  variant.name = name;
  if (name.empty() || name.find_first_of(",\"/ ") != std::string::npos)
    yaml.fail("", "must be named by one word, without commas and quotes");
  const bool recovers = yaml.has("recovery");
  if (recovers)
    read_recovery(variant, yaml);
  else
    read_wiring(variant, yaml);
  if (recovers && !on_can) yaml.fail("recovery", "needs the key `can`: this campaign is on FlexRay");
  if (!recovers && on_can) yaml.fail("", "must have recovery instead: this campaign is on a CAN");
  yaml.finish();
  return variant;
}

void read_weights(CampaignFile& campaign, YamlMap& root, bool on_can) {
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    campaign.weights[faults::index_of(kind)] = faults::is_on_can(kind) == on_can ? 1 : 0;
  auto classes = root.map_if("classes");
  if (!classes) return;
  std::int64_t sum = 0;
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    if (faults::is_on_can(kind) == on_can)
      sum += campaign.weights[faults::index_of(kind)] = classes->integer_or(faults::name_of(kind), 0, {0, kMostWeight});
  classes->finish();
  if (sum == 0) root.fail("classes", "must give a class a weight above 0");
}

// An expectation with `harmless` is one of a CAN.
void read_expectation(CampaignFile& campaign, YamlMap& expect, bool on_can) {
  if (expect.has("harmless")) {
    std::vector<std::string> kinds;
    for (const faults::FaultKind kind : faults::kAllFaultKinds)
      if (faults::is_on_can(kind)) kinds.emplace_back(faults::name_of(kind));
    for (const std::string& word : expect.words("harmless", kinds))
      for (const faults::FaultKind kind : faults::kAllFaultKinds)
        if (faults::name_of(kind) == word) campaign.harmless.push_back(kind);
    if (!on_can) expect.fail("harmless", "needs the key `can`: this campaign is on FlexRay");
  } else {
    campaign.expected_harmed = expect.integer("harmed_with_guardian", {0, kMostFaults});
    if (on_can)
      expect.fail("harmed_with_guardian", "must be harmless instead: a CAN has no guardian");
    else if (std::none_of(campaign.variants.begin(), campaign.variants.end(),
                          [](const Variant& v) { return v.guarded(); }))
      expect.fail("harmed_with_guardian", "needs a variant with guardian and both channels");
  }
  expect.finish();
}

}  // namespace

CampaignFile read_campaign(const StrictYaml& yaml) {
  expect_kind(yaml, FileKind::kExperiment);
  Findings findings;
  YamlMap root = yaml.root(findings);
  CampaignFile campaign;
  campaign.file = yaml.name();
  root.choice<bool>("kind", {{"fault_campaign", true}});
  findings.throw_if_any();  // the keys of another kind are not judged
  campaign.name = root.text("name");
  campaign.cluster_file =
      (std::filesystem::path(yaml.name()).parent_path() / root.text("cluster")).lexically_normal().string();
  campaign.cluster_line = root.line("cluster");
  campaign.faults = root.integer("faults", {1, kMostFaults});
  campaign.seed = static_cast<std::uint64_t>(root.integer("seed", sim::drives::kSeeds));
  const bool on_can = root.has("can");
  if (on_can) {
    campaign.can = root.text("can");
    campaign.can_line = root.line("can");
    campaign.duration = root.duration("duration", kTrials);
  } else {
    campaign.startup_share = root.number("start_up", {0.0, 1.0});
    campaign.restart_halted_after = static_cast<int>(root.integer("restart_halted_after", {0, 1000}, "cycles"));
    YamlMap cycles = root.map("cycles");
    campaign.steady_cycles = static_cast<int>(cycles.integer("steady_state", {20, kMostCycles}, "cycles"));
    campaign.startup_cycles = static_cast<int>(cycles.integer("start_up", {40, kMostCycles}, "cycles"));
    cycles.finish();
  }
  read_weights(campaign, root, on_can);
  for (auto& [name, map] : root.named_maps("variants")) campaign.variants.push_back(read_variant(name, map, on_can));
  if (campaign.variants.empty()) root.fail("variants", "must have at least one");
  if (auto expect = root.map_if("expect")) read_expectation(campaign, *expect, on_can);
  root.finish();
  findings.throw_if_any();
  return campaign;
}

CampaignFile load_campaign(const std::string& path) { return read_campaign(load_of_kind(path, FileKind::kExperiment)); }
CampaignFile parse_campaign(std::string text, std::string name) {
  return read_campaign(StrictYaml::parse(std::move(text), std::move(name)));
}

schedules::model::Cluster read_cluster_of(const CampaignFile& campaign) {
  (void)read_named_file(campaign.cluster_file, {campaign.file, campaign.cluster_line, "cluster", "", ""},
                        "a cluster file");
  return schedules::file::load_cluster(campaign.cluster_file);
}

}  // namespace ttf::experiments::campaign
