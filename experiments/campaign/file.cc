#include "experiments/campaign/file.h"

#include <algorithm>
#include <filesystem>

#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "drives/drive.h"
#include "schedules/check/checker.h"
#include "schedules/file/loader.h"

namespace ttf::experiments::campaign {
namespace {

using schedules::model::Channels;
using schedules::model::Topology;

constexpr std::int64_t kMostFaults = 100'000'000, kMostWeight = 1'000'000, kMostCycles = 10'000;

Variant read_variant(const std::string& name, YamlMap& yaml) {
  Variant variant;
  variant.name = name;
  if (name.empty() || name.find_first_of(",\"/ ") != std::string::npos)
    yaml.fail("", "must be named by one word, without commas and quotes");
  variant.topology = yaml.choice<Topology>("topology", {{"bus", Topology::kBus}, {"star", Topology::kStar}});
  variant.guardian = yaml.boolean("guardian");
  variant.channels = yaml.choice<Channels>("channels", {{"AB", Channels::kAB}, {"A", Channels::kA}});
  if (variant.guardian && variant.topology != Topology::kStar) yaml.fail("guardian", "needs topology: star");
  yaml.finish();
  return variant;
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
  campaign.seed = static_cast<std::uint64_t>(root.integer("seed", {0, std::int64_t{1} << 62}));
  campaign.startup_share = root.number("start_up", {0.0, 1.0});
  campaign.restart_halted_after = static_cast<int>(root.integer("restart_halted_after", {0, 1000}, "cycles"));
  YamlMap cycles = root.map("cycles");
  campaign.steady_cycles = static_cast<int>(cycles.integer("steady_state", {20, kMostCycles}, "cycles"));
  campaign.startup_cycles = static_cast<int>(cycles.integer("start_up", {40, kMostCycles}, "cycles"));
  cycles.finish();

  // A trial's controllers have no CAN.
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    campaign.weights[faults::index_of(kind)] = faults::is_on_can(kind) ? 0 : 1;
  if (auto classes = root.map_if("classes")) {
    std::int64_t sum = 0;
    for (const faults::FaultKind kind : faults::kAllFaultKinds)
      if (!faults::is_on_can(kind))
        sum += campaign.weights[faults::index_of(kind)] =
            classes->integer_or(faults::name_of(kind), 0, {0, kMostWeight});
    classes->finish();
    if (sum == 0) root.fail("classes", "must give a class a weight above 0");
  }
  for (auto& [name, map] : root.named_maps("variants")) campaign.variants.push_back(read_variant(name, map));
  if (campaign.variants.empty()) root.fail("variants", "must have at least one");
  if (auto expect = root.map_if("expect")) {
    campaign.expected_harmed = expect->integer("harmed_with_guardian", {0, kMostFaults});
    if (std::none_of(campaign.variants.begin(), campaign.variants.end(), [](const Variant& v) { return v.guarded(); }))
      expect->fail("harmed_with_guardian", "needs a variant with guardian and both channels");
    expect->finish();
  }
  root.finish();
  findings.throw_if_any();
  return campaign;
}

CampaignFile load_campaign(const std::string& path) { return read_campaign(load_of_kind(path, FileKind::kExperiment)); }
CampaignFile parse_campaign(std::string text, std::string name) {
  return read_campaign(StrictYaml::parse(std::move(text), std::move(name)));
}

schedules::model::Cluster cluster_of(const CampaignFile& campaign, const Variant& variant) {
  schedules::model::Cluster cluster = schedules::file::parse_cluster(
      read_named_file(campaign.cluster_file, {campaign.file, campaign.cluster_line, "cluster", "", ""},
                      "a cluster file"),
      campaign.cluster_file);
  cluster.topology = variant.topology;
  cluster.guardian = variant.guardian;
  Findings findings;
  for (schedules::model::Node& node : cluster.nodes) {
    if (!node.flexray) {
      findings.add(
          {cluster.file, node.line, "nodes." + node.name, "", "must be on FlexRay: a campaign has controllers only"});
      continue;
    }
    if (variant.channels == Channels::kA) {
      node.flexray->pChannels = Channels::kA;
      node.flexray->pWakeupChannel = schedules::model::Channel::kA;
    }
  }
  findings.throw_if_any();
  if (variant.channels == Channels::kA)
    for (schedules::model::FrameSlot& frame : cluster.frames) frame.channels = Channels::kA;
  if (auto wrong = schedules::check::check(cluster); !wrong.empty()) throw InputError(std::move(wrong));
  drives::check_described(cluster);
  return cluster;
}

}  // namespace ttf::experiments::campaign
