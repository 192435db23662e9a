// Supplies, clocks, schedules and start-up under faults: the effects on the node and on the others.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/faults/fault_bus.h"

namespace ttf::sim::faults {
namespace {

using bus::poc::PocKind;
using ttf::faults::DuplicateMode;
using ttf::faults::FaultKind;

bool was_in(const Said& said, PocKind state) {
  return std::find(said.states.begin(), said.states.end(), state) != said.states.end();
}

TEST(MachineryFaults, ACrashedNodesSlotIsEmptyUntilItIsBack) {
  FaultBus bus(with({fault_of(FaultKind::kCrash, 3, 10, 10)}));
  bus.run(5 * 15);
  EXPECT_EQ(bus.acts(), 1U);
  EXPECT_EQ(bus.said(0).count(4, bus::controller::kNoFrame), 2 * 5);
  bus.run(5 * 60);
  EXPECT_EQ(bus.acts(), 2U);
  EXPECT_EQ(bus.state(3), PocKind::kNormalActive);
  // Integration takes two cycles to derive a schedule and two good double cycles (bus/poc/poc.h), and the
  // wait for an even one.
  const int empty = bus.said(0).count(4, bus::controller::kNoFrame) / 2;
  EXPECT_GE(empty, 10 + 6);
  EXPECT_LE(empty, 10 + 8);
  ASSERT_EQ(bus.activities().size(), 4U);
  EXPECT_EQ(bus.activities()[0].what, recording::records::FaultAct::kBegins);
  EXPECT_EQ(bus.activities()[1].text, "node3 loses its supply");
  EXPECT_EQ(bus.activities()[2].text, "node3 has its supply back");
  EXPECT_EQ(bus.activities()[3].what, recording::records::FaultAct::kEnds);
}

// pRateCorrectionOut is 3005 ppm.
TEST(MachineryFaults, DriftThatGrowsBeyondTheLimitHaltsTheNodeAndNobodyElse) {
  std::vector<ttf::faults::Fault> steps;
  for (int step = 1; step <= 8; ++step) {
    steps.push_back(fault_of(FaultKind::kDrift, 3, 10 + 4 * step));
    steps.back().drift_ppb = 500'000 * step;
  }
  FaultBus bus(with(steps));
  bus.run(5 * 60);
  EXPECT_TRUE(bus.said(3).rate_limited);
  EXPECT_EQ(bus.state(3), PocKind::kHalt);
  for (const int n : {0, 1, 2}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
  EXPECT_GT(bus.said(0).count(4, bus::controller::kNoFrame), 0);
}

TEST(MachineryFaults, DriftThatJumpsLosesTheClusterBeforeAnythingIsMeasured) {
  ttf::faults::Fault fault = fault_of(FaultKind::kDrift, 3, 10);
  fault.drift_ppb = 6'000'000;  // 30 us in a cycle: out of every slot
  FaultBusConfig config = with({fault});
  config.cluster = engine::bus_cluster(4, 2, 3);
  FaultBus bus(std::move(config));
  bus.run(5 * 40);
  EXPECT_EQ(bus.acts(), 1U);
  EXPECT_TRUE(bus.said(3).clock_missing);
  EXPECT_TRUE(was_in(bus.said(3), PocKind::kNormalPassive));
  EXPECT_EQ(bus.state(3), PocKind::kHalt);
  for (const int n : {0, 1, 2}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
  EXPECT_GT(bus.said(0).count(4, bus::controller::kNoFrame), 0);
}

TEST(MachineryFaults, DriftWithinTheLimitIsCorrected) {
  ttf::faults::Fault fault = fault_of(FaultKind::kDrift, 3, 10);
  fault.drift_ppb = 1'000'000;
  FaultBus bus(with({fault}));
  bus.run(5 * 60);
  for (int n = 0; n < 4; ++n) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
  EXPECT_LE(bus.simulation().precision().ns, engine::kAssumedPrecision.ns);
}

TEST(MachineryFaults, OneByzantineClockOfThreeBreaksThePrecisionAndOneOfFourDoesNot) {
  const auto worst = [](int nodes, ttf::faults::ByzantinePattern pattern) {
    ttf::faults::Fault fault = fault_of(FaultKind::kByzantineClock, 0, 10);
    fault.shift = Duration{5'500};
    fault.pattern = pattern;
    Duration most{};
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      FaultBusConfig config = with({fault});
      config.cluster = engine::bus_cluster(nodes, 2, nodes);
      config.seed = seed;
      config.most_drift_ppb = 1'500'000;
      FaultBus bus(std::move(config));
      for (int ms = 60; ms < 500; ++ms) {
        bus.run(ms);
        most = std::max(most, bus.simulation().precision(NodeId{1}));
      }
      EXPECT_GT(bus.acts(), 150U);
    }
    return most;
  };
  for (const auto pattern : {ttf::faults::ByzantinePattern::kRandom, ttf::faults::ByzantinePattern::kPullApart,
                             ttf::faults::ByzantinePattern::kPullRates})
    EXPECT_LE(worst(4, pattern).ns, engine::kAssumedPrecision.ns) << static_cast<int>(pattern);
  EXPECT_GT(worst(3, ttf::faults::ByzantinePattern::kPullRates).ns, engine::kAssumedPrecision.ns);
}

TEST(MachineryFaults, ALoneColdstartNodeDoesNotStartUntilAnotherIsThere) {
  ttf::faults::Fault fault = fault_of(FaultKind::kLoneColdstart, 0, 0, 40);
  FaultBusConfig config = with({fault});
  config.cold = true;
  FaultBus bus(std::move(config));
  bus.run(5 * 40 - 1);
  EXPECT_TRUE(was_in(bus.said(0), PocKind::kColdstartCollisionResolution));
  EXPECT_TRUE(was_in(bus.said(0), PocKind::kColdstartGap));
  for (int n = 0; n < 4; ++n) EXPECT_FALSE(was_in(bus.said(n), PocKind::kNormalActive)) << n;
  EXPECT_EQ(bus.acts(), 1U);  // node 1 is the only other one
  bus.run(5 * 120);
  for (int n = 0; n < 4; ++n) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

TEST(MachineryFaults, AllOthersAreOff) {
  ttf::faults::Fault fault = fault_of(FaultKind::kLoneColdstart, 0, 10);
  fault.all_others = true;
  FaultBus bus(with({fault}));
  bus.run(5 * 20);
  EXPECT_EQ(bus.acts(), 3U);
  for (int slot = 2; slot <= 4; ++slot) EXPECT_GT(bus.said(0).count(slot, bus::controller::kNoFrame), 0);
}

// When nodes 0 to 2 are active at last [ms]; never: -1.
int started(FaultBusConfig config, int latest) {
  config.cold = true;
  FaultBus bus(std::move(config));
  for (int ms = 1; ms < latest; ++ms) {
    bus.run(ms);
    bool all = true;
    for (int n = 0; n < 3; ++n) all &= bus.state(n) == PocKind::kNormalActive;
    if (all) return ms;
  }
  return -1;
}

TEST(MachineryFaults, ANodeThatKeepsSendingCasKeepsTheOthersFromStarting) {
  // Its controller's frames do not leave it. It would lead, since it does not receive itself.
  ttf::faults::Fault fault = fault_of(FaultKind::kDuplicateColdstart, 3, 0, 60);
  fault.interval = Duration::milliseconds(3);
  const ttf::faults::Fault mute = fault_of(FaultKind::kOmission, 3, 0);
  const auto config = [](std::vector<ttf::faults::Fault> faults) {
    FaultBusConfig made = with(std::move(faults));
    made.cluster = engine::bus_cluster(4, 3, 4);
    return made;
  };
  const int undisturbed = started(config({mute}), 400);
  ASSERT_GT(undisturbed, 0);
  EXPECT_LT(undisturbed, 100);
  EXPECT_GT(started(config({mute, fault}), 1000), 300) << "not while it lasts";
}

TEST(MachineryFaults, RogueStartupFramesDisturbStartUp) {
  ttf::faults::Fault fault = fault_of(FaultKind::kDuplicateColdstart, 1, 0, 60);
  fault.duplicate = DuplicateMode::kStartupFrames;
  fault.from = Duration::milliseconds(2);
  FaultBusConfig config = with({fault});
  config.cold = true;
  FaultBus bus(std::move(config));
  bus.run(40);
  // They receive a startup frame before any node has begun, and take its schedule.
  EXPECT_TRUE(was_in(bus.said(0), PocKind::kInitialiseSchedule));
  EXPECT_FALSE(was_in(bus.said(0), PocKind::kColdstartCollisionResolution));
  EXPECT_EQ(bus.acts(), 2U * 8);
}

// Nodes 0 and 2 follow rogue frames as long as there are any, and start by them, later than among themselves. Where the
// frames end too soon, they have to begin anew.
TEST(MachineryFaults, RogueStartupFramesDelayStartUp) {
  const auto rogue = [](int cycles) {
    ttf::faults::Fault fault = fault_of(FaultKind::kDuplicateColdstart, 1, 0, cycles);
    fault.duplicate = DuplicateMode::kStartupFrames;
    fault.from = Duration::milliseconds(2);
    return fault;
  };
  const int undisturbed = started(with({}), 400);
  const int disturbed = started(with({rogue(60)}), 400), given_up = started(with({rogue(2)}), 400);
  ASSERT_GT(undisturbed, 0);
  EXPECT_GT(disturbed, undisturbed);
  EXPECT_LT(disturbed, 5 * 60) << "while the fault lasts";
  EXPECT_GT(given_up, disturbed);
}

TEST(MachineryFaults, TwoNodesWithOneKeySlotCollide) {
  ttf::faults::Fault fault = fault_of(FaultKind::kDuplicateColdstart, 1, 0);
  fault.duplicate = DuplicateMode::kSameKeySlot;
  FaultBus bus(with({fault}));
  bus.run(5 * 10);
  for (const int n : {2, 3}) {
    EXPECT_EQ(bus.said(n).count(1, bus::controller::kSyntaxError), 2 * 10) << n;
    EXPECT_EQ(bus.said(n).count(2, bus::controller::kNoFrame), 2 * 10) << n;
  }
  EXPECT_EQ(bus.said(0).count(1, bus::controller::kTransmissionConflict), 2 * 10);
  EXPECT_EQ(bus.acts(), 2U * 10);
}

ttf::faults::Fault wrong(ttf::faults::WrongSchedule mode, int by, int slot = 0) {
  ttf::faults::Fault fault = fault_of(FaultKind::kWrongSchedule, 3, 0);
  fault.wrong = mode;
  fault.by = by;
  fault.slot = slot;
  return fault;
}

TEST(MachineryFaults, ShiftedSlotsAreEmptyHereAndUnexpectedThere) {
  FaultBus bus(with({wrong(ttf::faults::WrongSchedule::kShiftedSlots, 3)}));
  bus.run(5 * 10);
  for (const int n : {0, 1, 2}) {
    EXPECT_EQ(bus.said(n).count(4, bus::controller::kNoFrame), 2 * 10) << n;
    EXPECT_EQ(bus.said(n).count(7, bus::controller::kUnexpectedFrame), 2 * 10) << n;
    EXPECT_EQ(bus.said(n).count(7, bus::controller::kContentError), 0) << n;
  }
}

TEST(MachineryFaults, TheKeySlotOfAnotherCollidesWithIt) {
  FaultBus bus(with({wrong(ttf::faults::WrongSchedule::kKeySlot, 0, 3)}));
  bus.run(5 * 10);
  for (const int n : {0, 1}) EXPECT_EQ(bus.said(n).count(3, bus::controller::kSyntaxError), 2 * 10) << n;
}

TEST(MachineryFaults, LongerFramesAreContentErrorsBothWays) {
  FaultBus bus(with({wrong(ttf::faults::WrongSchedule::kPayloadLength, 1)}));
  bus.run(5 * 10);
  for (const int n : {0, 1, 2}) EXPECT_EQ(bus.said(n).count(4, bus::controller::kContentError), 2 * 10) << n;
  for (const int slot : {1, 2, 3}) EXPECT_GT(bus.said(3).count(slot, bus::controller::kContentError), 0) << slot;
}

TEST(MachineryFaults, LongerSlotsMakeFramesLate) {
  FaultBus bus(with({wrong(ttf::faults::WrongSchedule::kStaticSlot, 6)}));
  bus.run(5 * 4);
  // Three slots before its own, 6 us each: more than the slot's margin.
  for (const int n : {0, 1, 2})
    EXPECT_GT(bus.said(n).count(4, bus::controller::kBoundaryViolation | bus::controller::kSyntaxError), 0) << n;
}

TEST(MachineryFaults, ALongerCycleLosesTheCluster) {
  FaultBusConfig config = with({wrong(ttf::faults::WrongSchedule::kCycleLength, 50)});
  config.cluster = engine::bus_cluster(4, 2, 3);
  FaultBus bus(std::move(config));
  bus.run(5 * 60);
  EXPECT_EQ(bus.state(3), PocKind::kHalt);
  for (const int n : {0, 1, 2}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

}  // namespace
}  // namespace ttf::sim::faults
