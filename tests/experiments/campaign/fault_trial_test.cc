// Single faults with predictable observers and harm.
#include "experiments/campaign/flexray/trial.h"

#include <gtest/gtest.h>

#include "evaluation/faults/checks.h"
#include "experiments/campaign/flexray/bus.h"
#include "tests/experiments/campaign/small_campaign.h"

namespace ttf::experiments::campaign {
namespace {

constexpr Duration kCycle = Duration::milliseconds(2);
constexpr NodeId kFusion{2}, kCamera{5};

class FaultTrial : public testing::Test {
 protected:
  FaultOutcome run(std::size_t variant, const faults::Fault& fault, bool starts_up = false,
                   std::uint32_t index = 3) const {
    return flexray::run_trial(campaign_, bus_.variant(variant), {fault, starts_up}, index);
  }
  static faults::Fault fault(faults::FaultKind kind, NodeId node) {
    faults::Fault fault;
    fault.kind = kind;
    fault.node = node;
    fault.from = kCycle * 5;
    return fault;
  }
  CampaignFile campaign_ = small_campaign(1);
  flexray::Bus bus_{campaign_};
};

// A fault that begins with the run and never does anything.
TEST_F(FaultTrial, WithoutAFaultNobodyNoticesAnythingOrIsHarmed) {
  faults::Fault nothing = fault(faults::FaultKind::kOmission, kCamera);
  nothing.from = Duration{};
  nothing.probability = 0.0;
  for (const std::size_t variant : {kGuardian, kBus})
    for (std::uint32_t index = 0; index < 40; ++index)
      for (const bool starts_up : {false, true}) {
        const FaultOutcome outcome = run(variant, nothing, starts_up, index);
        EXPECT_FALSE(outcome.activated);
        EXPECT_TRUE(outcome.starts_without);
        EXPECT_EQ(outcome.harms, 0) << "index " << index;
        EXPECT_EQ(outcome.seen_by_others, 0) << "index " << index;
        EXPECT_EQ(outcome.seen_by_itself, 0) << "index " << index;
        EXPECT_EQ(outcome.still_out, 0) << "index " << index;
      }
}

TEST_F(FaultTrial, ACrashIsAnEmptySlotAndTheNodeComesBack) {
  faults::Fault crash = fault(faults::FaultKind::kCrash, kFusion);
  crash.duration = kCycle * 4;
  for (const std::size_t variant : {kGuardian, kBus}) {
    const FaultOutcome outcome = run(variant, crash);
    EXPECT_TRUE(outcome.activated);
    EXPECT_TRUE(seen(outcome.seen_by_others, evaluation::faults::Check::kNoFrame));
    EXPECT_EQ(outcome.harms, 0);
    ASSERT_TRUE(outcome.detected_after && outcome.reintegrated_after);
    EXPECT_LE(*outcome.detected_after, kCycle.ns * 2);
    EXPECT_LE(*outcome.reintegrated_after, kCycle.ns * 12);
    EXPECT_EQ(outcome.still_out, 0);
  }
  crash.duration = faults::Fault::kToTheEnd;
  EXPECT_EQ(run(kBus, crash).still_out, 1);
}

TEST_F(FaultTrial, ABabblingIdiotTakesTheBusAndNotTheStar) {
  faults::Fault babbling = fault(faults::FaultKind::kBabblingIdiot, kCamera);
  babbling.length = Duration::microseconds(100);
  babbling.interval = Duration::microseconds(150);
  const FaultOutcome bus = run(kBus, babbling), star = run(kGuardian, babbling);
  EXPECT_TRUE(does(bus.harms, evaluation::faults::Harm::kFrameLost) &&
              does(bus.harms, evaluation::faults::Harm::kLeftActive));
  EXPECT_TRUE(bus.passive_after && bus.halt_after);
  EXPECT_EQ(star.harms, 0);
  EXPECT_EQ(star.seen_by_others, 1u << static_cast<unsigned>(evaluation::faults::Check::kGuardian))
      << "the others hear nothing of it";
}

// A frame more in another's slot, with the right header and a right CRC.
TEST_F(FaultTrial, AMasqueradeCollidesOnTheBusAndDoesNotGetThroughTheStar) {
  faults::Fault masquerade = fault(faults::FaultKind::kMasquerading, kCamera);
  masquerade.slot = 3;
  const FaultOutcome bus = run(kBus, masquerade), star = run(kGuardian, masquerade);
  EXPECT_TRUE(does(bus.harms, evaluation::faults::Harm::kFrameLost)) << "both send at once";
  EXPECT_EQ(star.harms, 0);
  EXPECT_TRUE(seen(star.seen_by_others, evaluation::faults::Check::kGuardian));
}

TEST_F(FaultTrial, ADriftBeyondTheLimitEndsInPassiveAndHalt) {
  faults::Fault drift = fault(faults::FaultKind::kDrift, kCamera);
  drift.drift_ppb = 20'000'000;
  const FaultOutcome star = run(kGuardian, drift);
  EXPECT_TRUE(seen(star.seen_by_itself, evaluation::faults::Check::kPassive) ||
              seen(star.seen_by_itself, evaluation::faults::Check::kHalt));
  EXPECT_TRUE(star.halt_after);
  EXPECT_EQ(star.harms, 0);
}

TEST_F(FaultTrial, AStartUpWithoutASecondColdstartNodeHarmsWhoWaitsForIt) {
  faults::Fault lone = fault(faults::FaultKind::kLoneColdstart, kFusion);
  lone.from = Duration{};
  for (const std::size_t variant : {kGuardian, kBus})
    EXPECT_TRUE(does(run(variant, lone, true).harms, evaluation::faults::Harm::kNotStarted));
  EXPECT_FALSE(bus_.in_hypothesis(lone));
}

TEST_F(FaultTrial, NoiseOnOneChannelLeavesTheOther) {
  faults::Fault noise = fault(faults::FaultKind::kNoise, kNoNode);
  noise.length = Duration::microseconds(300);
  noise.interval = Duration::microseconds(310);
  noise.channels = schedules::model::Channels::kB;
  for (const std::size_t variant : {kGuardian, kBus}) EXPECT_EQ(run(variant, noise).harms, 0);
  EXPECT_TRUE(bus_.in_hypothesis(noise));
  noise.channels = schedules::model::Channels::kAB;
  for (const std::size_t variant : {kGuardian, kBus})
    EXPECT_TRUE(does(run(variant, noise).harms, evaluation::faults::Harm::kLeftActive));
  EXPECT_FALSE(bus_.in_hypothesis(noise));
}

// Campaigns run on the transparent medium. Any fault has the same effects as with every frame encoded.
TEST_F(FaultTrial, OnATransparentMediumEveryFaultHasTheSameOutcome) {
  int activated = 0;
  for (std::uint32_t index = 0; index < 400; ++index) {
    const DrawnFault drawn = bus_.draw(index);
    for (const std::size_t variant : {kGuardian, kBus}) {
      const schedules::model::Cluster& cluster = bus_.variant(variant);
      const FaultOutcome outcome = flexray::run_trial(campaign_, cluster, drawn, index);
      EXPECT_EQ(outcome, flexray::run_trial(campaign_, cluster, drawn, index, nullptr, true))
          << "fault " << index << ": " << faults::entry_of(drawn.fault, bus_.cluster());
      activated += outcome.activated ? 1 : 0;
    }
  }
  EXPECT_GT(activated, 600);
}

}  // namespace
}  // namespace ttf::experiments::campaign
