// A campaign on a CAN: its file, its draws, and its table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "core/errors.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/coverage.h"
#include "experiments/campaign/csv.h"
#include "tests/experiments/campaign/small_can_campaign.h"

namespace ttf::experiments::campaign {
namespace {

using faults::FaultKind;
using testing::HasSubstr;

std::string refusal(std::string_view text) {
  try {
    (void)bus_of(parse_campaign(std::string(text), TTF_SOURCE_DIR "/experiments/small.yaml"));
  } catch (const InputError& error) {
    EXPECT_EQ(error.findings().size(), 1u) << text;
    return error.findings().front().sentence();
  }
  return "accepted";
}
std::string replaced(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(CanCampaign, TheShippedOneIsRead) {
  const CampaignFile campaign = load_campaign(TTF_SOURCE_DIR "/experiments/can_fault_campaign.yaml");
  EXPECT_GE(campaign.faults, 100'000);
  for (const FaultKind kind : faults::kAllFaultKinds)
    EXPECT_EQ(campaign.weights[faults::index_of(kind)], faults::is_on_can(kind) ? 1 : 0);
  EXPECT_FALSE(campaign.harmless.empty());
  EXPECT_TRUE(bus_of(campaign)->has_trait(0));
}

TEST(CanCampaign, MistakesInTheFileAreNamed) {
  const std::string good = can_campaign_text(10);
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_THAT(refusal(replaced(good, "can: observation_can", "can: observations")),
              HasSubstr("small.yaml:4: can = observations: must be a CAN of paper_event_triggered: laser_can, "));
  EXPECT_THAT(refusal(replaced(good, "can: observation_can", "can: laser_can")),
              HasSubstr("can = laser_can: must have at least 3 nodes: it has 2"));
  EXPECT_THAT(refusal(replaced(good, "150 ms", "1 ms")), HasSubstr("small.yaml:7: duration = 1 ms: must be "));
  EXPECT_THAT(refusal(replaced(good, "duration: 150 ms", "duration: 150 ms\nstart_up: 0.25")),
              HasSubstr("small.yaml:8: start_up: is not a known key"));
  EXPECT_THAT(refusal(replaced(good, "recovery: never", "recovery: seldom")),
              HasSubstr("variants.never.recovery = seldom: must be "));
  EXPECT_THAT(refusal(replaced(good, ", restart_after: 20 ms", "")),
              HasSubstr("variants.host.restart_after: is missing"));
  EXPECT_THAT(refusal(replaced(good, "{recovery: never}", "{recovery: never, restart_after: 20 ms}")),
              HasSubstr("variants.never.restart_after: is not a known key"));
  EXPECT_THAT(refusal(replaced(good, "{recovery: never}", "{topology: bus, guardian: false, channels: AB}")),
              HasSubstr("variants.never: must have recovery instead: this campaign is on a CAN"));
  EXPECT_THAT(refusal(good + "classes: {crash: 1, can_omission: 1}\n"), HasSubstr("classes.crash: is not a known key"));
  EXPECT_THAT(refusal(good + "classes: {can_omission: 0}\n"), HasSubstr("must give a class a weight above 0"));
  EXPECT_THAT(refusal(good + "expect: {harmed_with_guardian: 0}\n"),
              HasSubstr("expect.harmed_with_guardian = 0: must be harmless instead: a CAN has no guardian"));
  EXPECT_THAT(refusal(good + "expect: {harmless: [crash]}\n"), HasSubstr("expect.harmless[0] = crash: must be "));
}

TEST(CanCampaign, EveryKindIsDrawnAndEveryFaultCanBeInjected) {
  const CampaignFile campaign = small_can_campaign(1);
  const auto bus = bus_of(campaign);
  std::map<FaultKind, std::set<NodeId>> nodes;
  std::set<std::uint32_t> identifiers;
  for (std::uint32_t index = 0; index < 4000; ++index) {
    const faults::Fault fault = bus->draw(index).fault;
    nodes[fault.kind].insert(fault.node);
    if (fault.kind == FaultKind::kCanBabbling) identifiers.insert(fault.identifier);
    EXPECT_NO_THROW(faults::resolve({"", {fault}}, bus->cluster())) << "fault " << index;
    EXPECT_EQ(parameters_text(fault, bus->cluster()).find(','), std::string::npos);
    EXPECT_EQ(fault, bus->draw(index).fault);
    EXPECT_GE(fault.from, Duration::milliseconds(30));
    EXPECT_LE(fault.from, Duration::milliseconds(60));
  }
  EXPECT_EQ(nodes.size(), 6u);
  for (const auto& [kind, of_kind] : nodes)
    EXPECT_EQ(of_kind.size(), kind == FaultKind::kCanCorruption ? 2u : 3u) << faults::name_of(kind);
  EXPECT_LT(*identifiers.begin(), 64u);
  EXPECT_TRUE(identifiers.lower_bound(65) != identifiers.end() && *identifiers.lower_bound(65) < 80);
  EXPECT_GT(*identifiers.rbegin(), 80u);
}

// Some hundred faults, from shards: their table is that of one run, and reads back.
TEST(CanCampaign, ShardsPutTogetherAreTheWhole) {
  const CampaignFile campaign = small_can_campaign(120, "80 ms");
  const auto bus = bus_of(campaign);
  const std::vector<FaultResult> whole = run_campaign(campaign, *bus, {}, 1, nullptr);
  const std::string table = campaign_csv(campaign, *bus, whole);
  EXPECT_THAT(table, HasSubstr(",identifier,still_out,detected_after_ns,passive_after_ns,bus_off_after_ns,"));
  std::vector<std::vector<FaultResult>> shards;
  for (std::uint32_t part = 0; part < 3; ++part)
    shards.push_back(read_campaign_csv(
        campaign, *bus, campaign_csv(campaign, *bus, run_campaign(campaign, *bus, {part, 3}, 2, nullptr)), "shard"));
  EXPECT_EQ(campaign_csv(campaign, *bus, merged(campaign, shards)), table);

  for (const std::size_t variant : {kAutomatic, kHost, kNever}) {
    const Coverage coverage = coverage_of(campaign, *bus, whole, variant);
    EXPECT_EQ(coverage.classes.size(), 6u);
    EXPECT_THAT(coverage_text(coverage, bus->words()), HasSubstr("to bus off"));
    for (const ClassCoverage& row : coverage.classes) {
      EXPECT_GT(row.activated, 0u) << faults::name_of(row.kind);
      if (row.kind == FaultKind::kCanOmission || row.kind == FaultKind::kCanNoAcknowledgement) {
        EXPECT_EQ(row.harmed, 0u) << faults::name_of(row.kind);
      } else if (row.kind == FaultKind::kCanBabbling || row.kind == FaultKind::kCanStuckDominant) {
        EXPECT_GT(row.harmed, 0u) << faults::name_of(row.kind) << ": or the judge sees nothing";
      }
    }
  }
}

}  // namespace
}  // namespace ttf::experiments::campaign
