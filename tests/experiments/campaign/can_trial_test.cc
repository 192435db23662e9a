// Single faults on a CAN with predictable observers and harm, and the two ways of its medium.
#include "experiments/campaign/can/trial.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tests/experiments/campaign/small_can_campaign.h"

namespace ttf::experiments::campaign {
namespace {

using evaluation::faults::CanCheck;
using evaluation::faults::CanHarm;
using faults::FaultKind;

class CanTrial : public testing::Test {
 protected:
  FaultOutcome run(std::size_t variant, const faults::Fault& fault, std::uint32_t index = 3) const {
    return bus_.run(variant, {fault, false}, index, nullptr);
  }
  NodeId node(std::string_view name) const { return bus_.cluster().find_node(name).value(); }
  faults::Fault fault(FaultKind kind, std::string_view name) const {
    faults::Fault fault;
    fault.kind = kind;
    fault.node = node(name);
    fault.can = bus_.setting().bus;
    fault.from = Duration::milliseconds(40);
    return fault;
  }
  const CampaignFile campaign_ = small_can_campaign(1);
  const can::Bus bus_{campaign_};
};

// The heaviest traffic of the schedule stays within the analysed response times.
TEST_F(CanTrial, WithoutAFaultNobodyNoticesAnythingOrIsHarmed) {
  faults::Fault nothing = fault(FaultKind::kCanOmission, "laser_pre");
  nothing.probability = 0.0;
  nothing.from = Duration{};
  for (const char* name : {"laser_pre", "camera_pre"}) {
    nothing.node = node(name);
    for (std::uint32_t index = 0; index < 60; ++index)
      EXPECT_EQ(run(kAutomatic, nothing, index), FaultOutcome{}) << index;
  }
}

TEST_F(CanTrial, AnOmissionTearsListsAndHarmsNobody) {
  faults::Fault omission = fault(FaultKind::kCanOmission, "laser_pre");
  omission.every = 2;
  const FaultOutcome outcome = run(kAutomatic, omission);
  EXPECT_TRUE(outcome.activated);
  EXPECT_TRUE(seen(outcome.seen_by_others, CanCheck::kTorn));
  EXPECT_EQ(outcome.harms, 0);
}

// Each attempt fails, with 8 errors. It is error passive after 16 of them. It is bus off after 32.
TEST_F(CanTrial, ACorruptingNodeIsOffTheBusAndRecoversAsItsVariantSays) {
  faults::Fault corruption = fault(FaultKind::kCanCorruption, "camera_pre");
  corruption.bit = 200;  // in the data
  corruption.duration = Duration::milliseconds(30);
  for (const std::size_t variant : {kAutomatic, kHost, kNever}) {
    const FaultOutcome outcome = run(variant, corruption);
    EXPECT_TRUE(seen(outcome.seen_by_itself, CanCheck::kBit) && seen(outcome.seen_by_itself, CanCheck::kBusOff));
    EXPECT_FALSE(seen(outcome.seen_by_others, CanCheck::kBusOff));
    ASSERT_TRUE(outcome.passive_after && outcome.halt_after);
    EXPECT_LT(*outcome.passive_after, *outcome.halt_after);
    EXPECT_LT(*outcome.halt_after, Duration::milliseconds(20).ns);
    EXPECT_EQ(outcome.harms, 0) << variant << ": the laser's lists have the lower identifier";
    EXPECT_EQ(outcome.still_out, variant == kNever ? 1 : 0);
    EXPECT_EQ(outcome.reintegrated_after.has_value(), variant != kNever);
  }
}

// Identifier 64 has recessive bits at 5, 6 and 12. Bits 5 and 12 are stuff bits. Seen dominant, bit 6 is another's lower
// identifier: what follows counts as a receiver's error. A stuff bit is an error that does not count (Bosch CAN
// Specification 2.0, part B, chapter 8, rule 3, exception 2). So the faulty node keeps the bus.
TEST_F(CanTrial, ARecessiveBitOfTheIdentifierThatIsSeenDominantCountsNothing) {
  faults::Fault corruption = fault(FaultKind::kCanCorruption, "laser_pre");
  corruption.duration = Duration::milliseconds(30);
  for (int bit = 1; bit < 14; ++bit) {
    corruption.bit = bit;
    const FaultOutcome outcome = run(kNever, corruption);
    const bool recessive = bit == 5 || bit == 6 || bit == 12;
    EXPECT_EQ(outcome.halt_after.has_value(), !recessive) << bit;
    EXPECT_EQ(does(outcome.harms, CanHarm::kUncontained), recessive) << bit;
    EXPECT_EQ(does(outcome.harms, CanHarm::kFrameLate), recessive) << bit << ": the camera's identifier is higher";
    EXPECT_EQ(seen(outcome.seen_by_itself, CanCheck::kPassive), bit != 5 && bit != 12) << bit;
  }
}

// In zeros every sixth bit is a stuff bit. Bit 101 is one. The receivers see it dominant, and begin their flags. Five
// dominant bits follow, so the transmitter notices 1.2 us later. Its flag outlasts theirs. They count 9 (rules 1 and 2),
// and are error passive after 15 attempts. The transmitter is so after 16. A missing acknowledgement counts nothing from
// then on (rule 3, exception 1). The laser's frames are late. Their starts meet the transmitter's intermission, and its
// overload flag overwrites them.
TEST_F(CanTrial, AStuffBitThatAllOthersSeeWrongMakesThemPassiveFirst) {
  faults::Fault corruption = fault(FaultKind::kCanCorruption, "camera_pre");
  corruption.duration = Duration::milliseconds(30);
  corruption.receivers = {node("laser_pre"), node("fusion")};
  corruption.bit = 102;
  EXPECT_TRUE(run(kNever, corruption).halt_after.has_value());
  EXPECT_EQ(run(kNever, corruption).harms, 0);
  corruption.bit = 101;
  Story story;
  const FaultOutcome outcome = bus_.run(kNever, {corruption, false}, 3, &story);
  EXPECT_FALSE(outcome.halt_after.has_value());
  EXPECT_TRUE(does(outcome.harms, CanHarm::kUncontained));
  EXPECT_TRUE(does(outcome.harms, CanHarm::kFrameLate));
  EXPECT_EQ(outcome.sender, node("camera_pre"));
  std::vector<std::string> changes;
  int overwritten = 0;
  for (const Story::Line& line : story.lines()) {
    if (line.text.find("-> error passive") != std::string::npos) changes.push_back(line.text);
    if (line.text.find("laser_pre begins an error frame as transmitter: stuff error; it has 0 transmit") == 0)
      ++overwritten;
  }
  EXPECT_EQ(changes,
            (std::vector<std::string>{"laser_pre: error active -> error passive; 0 transmit and 135 receive errors",
                                      "fusion: error active -> error passive; 0 transmit and 135 receive errors",
                                      "camera_pre: error active -> error passive; 128 transmit and 0 receive errors"}));
  EXPECT_GT(overwritten, 10);
}

TEST_F(CanTrial, ABabblingNodeHarmsTheIdentifiersAboveItsOwn) {
  faults::Fault babbling = fault(FaultKind::kCanBabbling, "laser_pre");
  babbling.interval = Duration::microseconds(10);
  const FaultOutcome low = run(kAutomatic, babbling);
  EXPECT_TRUE(does(low.harms, CanHarm::kFrameLost));
  EXPECT_EQ(low.sender, node("camera_pre"));
  EXPECT_EQ(low.frame_id, 80);
  EXPECT_TRUE(seen(low.seen_by_others, CanCheck::kForeign));
  babbling.node = node("camera_pre");
  babbling.identifier = 2000;  // its frames are shorter than the camera's
  EXPECT_EQ(run(kAutomatic, babbling).harms, 0);
}

// A stuck driver takes fault-free transmitters off the bus. Some stay off.
TEST_F(CanTrial, AStuckLineHarmsAllAndWhoRecoversComesBack) {
  faults::Fault stuck = fault(FaultKind::kCanStuckDominant, "fusion");
  stuck.duration = Duration::milliseconds(20);
  for (const std::size_t variant : {kAutomatic, kHost, kNever}) {
    const FaultOutcome outcome = run(variant, stuck);
    EXPECT_TRUE(seen(outcome.seen_by_others, CanCheck::kPassive));
    EXPECT_NE(outcome.harms, 0);
  }
  stuck.duration = faults::Fault::kToTheEnd;
  EXPECT_TRUE(does(run(kAutomatic, stuck).harms, CanHarm::kFrameLost));
}

TEST_F(CanTrial, ANodeThatDoesNotAcknowledgeDoesNoHarm) {
  for (const char* name : {"laser_pre", "camera_pre", "fusion"}) {
    const FaultOutcome outcome = run(kNever, fault(FaultKind::kCanNoAcknowledgement, name));
    EXPECT_TRUE(outcome.activated);
    EXPECT_EQ(outcome.harms + outcome.seen_by_others + outcome.seen_by_itself, 0) << name;
  }
}

// All that a trial's hosts get, one line each, beside its story of errors and states.
class Diary final : public can::Witness {
 public:
  void received(NodeId receiver, const bus::ports::CanFrame& frame, TrueTime at) override {
    std::string text = fmt::format("{} at {}: {:x}", at.ns, index_of(receiver), frame.identifier);
    for (const std::byte byte : frame.data) text += fmt::format(" {:02x}", static_cast<int>(byte));
    lines.push_back(text);
  }
  void sent(NodeId sender, TrueTime at) override {
    lines.push_back(fmt::format("{} sent by {}", at.ns, index_of(sender)));
  }
  std::vector<std::string> all(const Story& story) const {
    std::vector<std::string> both = lines;
    for (const Story::Line& line : story.lines()) both.push_back(fmt::format("{} {}", line.at.ns, line.text));
    return both;
  }
  std::vector<std::string> lines;
};

// The frames, errors and states come at the same instants, beside other traffic, too.
TEST(CanWaysOfACampaign, BothWaysAreTheSameForDrawnFaults) {
  const CampaignFile campaign = small_can_campaign(1, "60 ms");
  const can::Bus bus(campaign);
  schedules::model::Cluster busier = bus.cluster();
  busier.can_buses[bus.setting().bus].other_load = 0.3;
  for (const schedules::model::Cluster* cluster : {&bus.cluster(), &std::as_const(busier)}) {
    const can::Setting setting{campaign, *cluster, bus.setting().bus};
    int activated = 0;
    for (std::uint32_t index = 0; index < 120; ++index) {
      const DrawnFault drawn = bus.draw(index);
      for (const Variant& variant : campaign.variants) {
        std::array<Diary, 2> diaries;
        std::array<Story, 2> stories;
        std::array<FaultOutcome, 2> outcomes;
        for (const std::size_t way : {0, 1})
          outcomes[way] = can::run_trial(setting, variant, drawn, index, &stories[way], way == 1, &diaries[way]);
        const std::string which =
            fmt::format("fault {}, {}, other load {}: {}", index, variant.name,
                        cluster->can_buses[setting.bus].other_load, faults::entry_of(drawn.fault, *cluster));
        EXPECT_EQ(outcomes[0], outcomes[1]) << which;
        ASSERT_EQ(diaries[0].all(stories[0]), diaries[1].all(stories[1])) << which;
        activated += outcomes[0].activated ? 1 : 0;
      }
    }
    EXPECT_GT(activated, 200);
  }
}

}  // namespace
}  // namespace ttf::experiments::campaign
