// Normal operation: degradation by clock errors and recovery, deferred commands, key slot only mode.
#include "tests/bus/poc/poc_script.h"

namespace ttf::bus::poc {
namespace {

// A coldstart node in cycle 7, normal active.
PocScript active(PocParameters parameters = coldstart_node()) {
  PocScript node(parameters);
  node.to_active();
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);
  return node;
}

TEST(PocClock, PassiveAtItsThresholdAndNotBefore) {
  PocScript node = active();
  node.double_cycles(1, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);
  EXPECT_EQ(node.state.vClockCorrectionFailed, 1);
  node.apply(PocEvent::clock_corrected(true, false));
  EXPECT_EQ(node.state.vClockCorrectionFailed, 2);
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);  // until the cycle has ended
  node.apply(PocEvent::cycle_started(10, kTwoNodes));
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  EXPECT_EQ(node.last.reason, PocReason::kPassiveByMissingTerms);
  EXPECT_EQ(mac_mode(node.state), MacMode::kNothing);
  EXPECT_TRUE(corrects_clock(node.state.kind));
}

TEST(PocClock, OneGoodDoubleCycleBeginsTheCountAnew) {
  PocScript node = active();
  node.double_cycles(1, true).double_cycles(1, false).double_cycles(1, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);
  EXPECT_EQ(node.state.vClockCorrectionFailed, 1);
}

TEST(PocClock, HaltAtTheFatalThreshold) {
  PocScript node = active();
  node.double_cycles(3, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  node.double_cycles(1, true);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  EXPECT_EQ(node.state.halted_from, Kind::kNormalPassive);
  EXPECT_FALSE(node.state.frozen);
}

TEST(PocClock, HaltFromActiveIfBothThresholdsAreTheSame) {
  PocParameters parameters = coldstart_node();
  parameters.gMaxWithoutClockCorrectionPassive = parameters.gMaxWithoutClockCorrectionFatal = 2;
  PocScript node = active(parameters);
  node.double_cycles(2, true);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  EXPECT_EQ(node.state.halted_from, Kind::kNormalActive);
}

TEST(PocClock, StaysPassiveWhereHaltIsNotAllowed) {
  PocParameters parameters = coldstart_node();
  parameters.pAllowHaltDueToClock = false;
  PocScript node = active(parameters);
  node.double_cycles(40, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  EXPECT_EQ(node.state.vClockCorrectionFailed, kMaxClockCorrectionFailed);
}

TEST(PocClock, BeyondTheLimitHaltsAtOnceOrMakesPassive) {
  PocScript node = active();
  node.double_cycles(1, false, true);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  PocParameters parameters = coldstart_node();
  parameters.pAllowHaltDueToClock = false;
  node = active(parameters);
  node.double_cycles(1, false, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  EXPECT_EQ(node.state.vClockCorrectionFailed, 0);  // no term was missing
  node = active(parameters);
  node.double_cycles(1, true, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  EXPECT_EQ(node.state.vClockCorrectionFailed, 1);
}

TEST(PocClock, BackToActiveAfterConsecutiveGoodDoubleCycles) {
  PocScript node(coldstart_node());
  node.to_passive();
  ASSERT_EQ(node.state.kind, Kind::kNormalPassive);
  node.double_cycles(2, false);
  EXPECT_EQ(node.state.vAllowPassiveToActive, 2);
  node.double_cycles(1, true);  // breaks the row
  EXPECT_EQ(node.state.vAllowPassiveToActive, 0);
  node.double_cycles(2, false);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  node.cycle(kTwoNodes);
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);
  EXPECT_EQ(node.last.reason, PocReason::kBackToActive);
  EXPECT_EQ(node.state.vAllowPassiveToActive, 0);
  EXPECT_EQ(mac_mode(node.state), MacMode::kAll);
}

TEST(PocClock, BeyondTheLimitWhilePassiveHaltsOrBreaksTheRow) {
  PocScript node(coldstart_node());
  node.to_passive().double_cycles(1, false, true);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  EXPECT_EQ(node.last.next.halted_from, Kind::kNormalPassive);
  PocParameters parameters = coldstart_node();
  parameters.pAllowHaltDueToClock = false;
  node = PocScript(parameters);
  node.to_passive().double_cycles(2, false).double_cycles(1, false, true);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
  EXPECT_EQ(node.state.vAllowPassiveToActive, 0);
}

TEST(PocClock, NeverBackToActiveWithZero) {
  PocParameters parameters = coldstart_node();
  parameters.pAllowPassiveToActive = 0;
  PocScript node(parameters);
  node.to_passive().double_cycles(100, false);
  EXPECT_EQ(node.state.kind, Kind::kNormalPassive);
}

TEST(PocHost, HaltAndReadyWaitForTheEndOfTheCycle) {
  PocScript node = active();
  node.apply(Event::kHalt);
  EXPECT_EQ(node.last.reason, PocReason::kHaltRequested);
  EXPECT_EQ(mac_mode(node.state), MacMode::kAll);
  node.cycle(kTwoNodes);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  EXPECT_TRUE(node.last.actions.has(PocAction::kDropSchedule));
  node.apply(Event::kRun);
  EXPECT_EQ(node.last.reason, PocReason::kCommandNotAccepted);
  node.apply(Event::kConfig);
  EXPECT_EQ(node.state, poc_power_on(node.parameters));

  node = active();
  node.apply(Event::kReady).cycle(kTwoNodes);
  EXPECT_EQ(node.state.kind, Kind::kReady);
  EXPECT_FALSE(node.state.ready_requested);
  EXPECT_TRUE(node.state.vColdstartInhibit);
  node.apply(Event::kRun);
  EXPECT_EQ(node.state.kind, Kind::kIntegrationListen);
}

TEST(PocHost, FreezeActsAtOnceAndRemembersWhere) {
  PocScript node = active();
  node.apply(Event::kFreeze);
  EXPECT_EQ(node.state.kind, Kind::kHalt);
  EXPECT_TRUE(node.state.frozen);
  EXPECT_EQ(node.state.halted_from, Kind::kNormalActive);
  node = active();
  node.apply(Event::kHalt).cycle(kTwoNodes).apply(Event::kFreeze);
  EXPECT_TRUE(node.state.frozen);
  EXPECT_EQ(node.state.halted_from, Kind::kHalt);
  // Frozen once is frozen: where from is kept.
  node = active();
  node.apply(Event::kFreeze).apply(Event::kFreeze);
  EXPECT_EQ(node.last.reason, PocReason::kAlreadyFrozen);
  EXPECT_EQ(node.state.halted_from, Kind::kNormalActive);
}

TEST(PocHost, ConfigurationAndRunBeginAnew) {
  PocScript node(coldstart_node());
  node.to_listen().apply(Event::kNoiseTimeout).apply(Event::kReady);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 3);
  EXPECT_TRUE(node.state.coldstart_noise);
  PocScript configured = node;
  configured.apply(Event::kConfig);
  EXPECT_EQ(configured.state.vRemainingColdstartAttempts, 4);
  node.apply(Event::kRun);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 4);
  EXPECT_FALSE(node.state.coldstart_noise);
}

TEST(PocHost, KeySlotOnlyUntilAllSlotsAndTheNextCycle) {
  PocParameters parameters = coldstart_node();
  parameters.pKeySlotOnlyEnabled = true;
  PocScript node = active(parameters);
  EXPECT_EQ(mac_mode(node.state), MacMode::kKeySlot);
  node.apply(Event::kAllSlots);
  EXPECT_EQ(node.state.slot_mode, SlotMode::kAllPending);
  EXPECT_EQ(mac_mode(node.state), MacMode::kKeySlot);
  node.cycle(kTwoNodes);
  EXPECT_EQ(mac_mode(node.state), MacMode::kAll);
  node.apply(Event::kAllSlots);
  EXPECT_EQ(node.last.reason, PocReason::kCommandNotAccepted);
  node.apply(Event::kReady).cycle(kTwoNodes);
  EXPECT_EQ(node.state.slot_mode, SlotMode::kKeySlotOnly);
  // A request while passive takes effect when active again.
  node = PocScript(parameters);
  node.to_passive().apply(Event::kAllSlots).double_cycles(3, false);
  EXPECT_EQ(node.state.kind, Kind::kNormalActive);
  EXPECT_EQ(mac_mode(node.state), MacMode::kAll);
}

TEST(PocHost, PowerOnForgetsEverything) {
  PocScript node(coldstart_node());
  node.to_passive().apply(Event::kHalt).apply(Event::kPowerOn);
  EXPECT_EQ(node.state, poc_power_on(node.parameters));
  EXPECT_TRUE(node.last.actions.has(PocAction::kDropSchedule));
}

}  // namespace
}  // namespace ttf::bus::poc
