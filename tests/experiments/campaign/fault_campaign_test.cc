#include "experiments/campaign/campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "core/errors.h"
#include "experiments/campaign/coverage.h"
#include "experiments/campaign/csv.h"
#include "experiments/campaign/flexray/draw.h"
#include "tests/experiments/campaign/small_campaign.h"

namespace ttf::experiments::campaign {
namespace {

using testing::HasSubstr;

std::vector<FaultResult> run(const CampaignFile& campaign, const CampaignBus& bus, unsigned workers,
                             results::Shard shard = {}) {
  return run_campaign(campaign, bus, shard, workers, nullptr);
}

std::string refusal(std::string_view text) {
  try {
    parse_campaign(std::string(text), TTF_SOURCE_DIR "/experiments/small.yaml");
  } catch (const InputError& error) {
    return error.findings().front().sentence();
  }
  return "accepted";
}
std::string replaced(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(FaultCampaign, TheShippedOneIsRead) {
  const CampaignFile campaign = load_campaign(TTF_SOURCE_DIR "/experiments/fault_campaign.yaml");
  EXPECT_GE(campaign.faults, 100'000);
  EXPECT_EQ(campaign.expected_harmed, 0);
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    EXPECT_EQ(campaign.weights[faults::index_of(kind)], faults::is_on_can(kind) ? 0 : 1)
        << "all classes on FlexRay: the cluster has no CAN";
  EXPECT_TRUE(campaign.variants.front().guarded());
  EXPECT_NO_THROW(bus_of(campaign));
}

TEST(FaultCampaign, MistakesInTheFileAreNamed) {
  const std::string good = campaign_text(10);
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_THAT(refusal(replaced(good, "fault_campaign", "sweep")),
              HasSubstr("small.yaml:1: kind = sweep: must be fault_campaign"));
  EXPECT_THAT(refusal(replaced(good, "faults: 10", "faults: 0")),
              HasSubstr("small.yaml:4: faults = 0: must be a whole number 1.."));
  EXPECT_THAT(refusal(replaced(good, "start_up: 0.25", "start_up: 2")),
              HasSubstr("start_up = 2: must be a number 0..1"));
  EXPECT_THAT(refusal(replaced(good, "topology: bus, guardian: false", "topology: bus, guardian: true")),
              HasSubstr("needs topology: star"));
  EXPECT_THAT(refusal(good + "classes: {crash: 0}\n"), HasSubstr("must give a class a weight above 0"));
  EXPECT_THAT(refusal(good + "classes: {crush: 1}\n"), HasSubstr("crush: is not a known key"));
  EXPECT_THAT(refusal(replaced(good, "guardian: true", "guardian: false") + "expect: {harmed_with_guardian: 0}\n"),
              HasSubstr("small.yaml:12: expect.harmed_with_guardian"));
  EXPECT_THAT(refusal(good + "extra: 1\n"), HasSubstr("extra: is not a known key"));
}

TEST(FaultCampaign, EveryClassIsDrawnAndEveryFaultCanBeInjected) {
  const CampaignFile campaign = small_campaign(1);
  const auto bus = bus_of(campaign);
  std::set<faults::FaultKind> kinds;
  for (std::uint32_t index = 0; index < 4000; ++index) {
    const DrawnFault drawn = bus->draw(index);
    kinds.insert(drawn.fault.kind);
    EXPECT_NO_THROW(faults::resolve({"", {drawn.fault}}, bus->cluster())) << "fault " << index;
    EXPECT_EQ(parameters_text(drawn.fault, bus->cluster()).find(','), std::string::npos);
    EXPECT_EQ(drawn.fault, bus->draw(index).fault);
  }
  EXPECT_EQ(kinds.size(), faults::kAllFaultKinds.size() - 6);  // all but those of a CAN
}

// A printed fault is an entry of a fault plan, and reads back as the same fault.
TEST(FaultCampaign, APrintedFaultReadsBackAsTheSame) {
  const CampaignFile campaign = small_campaign(1);
  const auto bus = bus_of(campaign);
  const auto read_again = [&](const faults::Fault& fault) {
    const std::string entry = faults::entry_of(fault, bus->cluster());
    const StrictYaml yaml = StrictYaml::parse("faults:\n  - " + entry + "\n", "printed.yaml");
    Findings findings;
    YamlMap root = yaml.root(findings);
    faults::FaultPlan plan = faults::load_fault_plan(root, Duration::milliseconds(3'600'000));
    root.finish();
    findings.throw_if_any();
    plan = faults::resolve(plan, bus->cluster());
    faults::Fault again = plan.faults.at(0);
    again.node_name.clear();
    again.receiver_names.clear();
    again.line = 0;
    return again;
  };
  for (std::uint32_t index = 0; index < 4000; ++index) {
    const faults::Fault fault = bus->draw(index).fault;
    EXPECT_EQ(read_again(fault), fault) << faults::entry_of(fault, bus->cluster());
  }
  faults::Fault bits;
  bits.kind = faults::FaultKind::kBitFlipPayload;
  bits.node = NodeId{0};
  bits.bits = {0, 7, 15};
  bits.receivers = {NodeId{1}, NodeId{2}};
  bits.probability = 1.0 / 3.0;
  EXPECT_EQ(read_again(bits), bits);
  EXPECT_EQ(parameters_text(bits, bus->cluster()),
            "bits: [0+7+15]; receivers: [" + bus->cluster().nodes[1].name + "+" + bus->cluster().nodes[2].name +
                "]; probability: 0.3333333333333333; every: 1; channels: AB; from: 0 ns");
}

TEST(FaultCampaign, DrawsNoFaultThatTheClusterHasNoRoomFor) {
  const CampaignFile campaign = small_campaign(1, "classes: {wrong_schedule: 1, duplicate_coldstart: 1}\n");
  schedules::model::Cluster cluster = bus_of(campaign)->cluster();
  cluster.flexray.gPayloadLengthStatic = 127;
  cluster.flexray.gdNIT = cluster.flexray.gMacroPerCycle - cluster.flexray.gOffsetCorrectionStart + 2;
  std::set<faults::WrongSchedule> wrong;
  for (std::uint32_t index = 0; index < 1000; ++index) {
    const faults::Fault fault = flexray::draw_fault(campaign, cluster, index).fault;
    if (fault.kind == faults::FaultKind::kWrongSchedule) wrong.insert(fault.wrong);
  }
  using faults::WrongSchedule;
  EXPECT_EQ(wrong, (std::set{WrongSchedule::kShiftedSlots, WrongSchedule::kCycleLength, WrongSchedule::kKeySlot}));
}

TEST(FaultCampaign, WeightsSayHowManyOfWhichClass) {
  const CampaignFile campaign = small_campaign(1, "classes: {crash: 3, noise: 1}\n");
  const auto bus = bus_of(campaign);
  int crashes = 0, others = 0;
  for (std::uint32_t index = 0; index < 4000; ++index) {
    const faults::FaultKind kind = bus->draw(index).fault.kind;
    crashes += kind == faults::FaultKind::kCrash;
    others += kind != faults::FaultKind::kCrash && kind != faults::FaultKind::kNoise;
  }
  EXPECT_EQ(others, 0);
  EXPECT_NEAR(crashes, 3000, 150);
}

TEST(FaultCampaign, ResultsOfAnotherCampaignAreRefused) {
  const CampaignFile campaign = small_campaign(6);
  const auto bus = bus_of(campaign);
  const std::string text = campaign_csv(campaign, *bus, run(campaign, *bus, 2));
  CampaignFile another = campaign;
  another.seed = 8;
  EXPECT_THROW(read_campaign_csv(another, *bus_of(another), text, "results.csv"), InputError);
  EXPECT_NO_THROW(read_campaign_csv(campaign, *bus_of(campaign), text, "results.csv"));
  EXPECT_THROW(read_campaign_csv(campaign, *bus, text.substr(1), "results.csv"), InputError);
  EXPECT_THROW(read_campaign_csv(campaign, *bus, text.substr(0, text.size() - 3), "results.csv"), InputError);
  const std::size_t last_line = text.rfind('\n', text.size() - 2);
  EXPECT_THROW(read_campaign_csv(campaign, *bus, text.substr(0, last_line + 1), "results.csv"), InputError);
}

TEST(FaultCampaign, CountsAndTimesOfTheTable) {
  const CampaignFile campaign = small_campaign(4, "classes: {crash: 1}\n");
  const auto bus = bus_of(campaign);
  std::vector<FaultResult> results;
  for (std::uint32_t index = 0; index < 4; ++index) {
    FaultOutcome outcome;
    outcome.activated = index != 3;
    outcome.seen_by_others = index == 2 ? 0 : 1u << static_cast<unsigned>(evaluation::faults::Check::kNoFrame);
    if (index < 2) outcome.detected_after = 2'000'000 * (index + 1);
    outcome.harms = index == 1 ? 1u << static_cast<unsigned>(evaluation::faults::Harm::kFrameLost) : 0;
    results.push_back({index, bus->draw(index), {outcome, {}}});
  }
  const Coverage coverage = coverage_of(campaign, *bus, results, kGuardian);
  ASSERT_EQ(coverage.classes.size(), 1u);
  const ClassCoverage& crash = coverage.classes.front();
  EXPECT_EQ(crash.injected, 4u);
  EXPECT_EQ(crash.activated, 3u);
  EXPECT_EQ(crash.detected, 2u) << "of the activated";
  EXPECT_EQ(crash.by_check[static_cast<std::size_t>(evaluation::faults::Check::kNoFrame)], 2u);
  EXPECT_EQ(crash.detect.median_ns, 2'000'000);
  EXPECT_EQ(crash.detect.worst_ns, 4'000'000);
  EXPECT_EQ(crash.passive.count, 0u);
  EXPECT_EQ(coverage.harmed_in_hypothesis, 1u);
  EXPECT_EQ(coverage_of(campaign, *bus, results, kBus).harmed_in_hypothesis, 0u);
}

}  // namespace
}  // namespace ttf::experiments::campaign
