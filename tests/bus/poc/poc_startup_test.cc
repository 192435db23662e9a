// Start-up and wake-up, one node at a time. Its controller's reports are given in order.
#include "tests/bus/poc/poc_script.h"

namespace ttf::bus::poc {
namespace {

// Feeds cycle after cycle until the node is normal active. Returns the number of the cycle that began with
// it, -1: never.
int active_in(PocScript& script, const std::vector<StartupFramesSeen>& ended_cycles) {
  for (const StartupFramesSeen& ended : ended_cycles) {
    script.cycle(ended);
    if (script.state.kind == Kind::kNormalActive) return script.last_cycle;
  }
  return -1;
}

TEST(PocStartup, LeadingColdstartNodeIsActiveInCycle6) {
  PocScript node(coldstart_node());
  node.to_listen();
  EXPECT_EQ(node.last.consequence, PocReason::kMayColdstart);
  node.apply(Event::kListenTimeout);
  EXPECT_TRUE(node.last.actions.has(PocAction::kSendCas));
  EXPECT_EQ(node.last.reason, PocReason::kColdstartAfterSilence);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 3);
  EXPECT_FALSE(node.state.coldstart_noise);
  // Before cycle 0, cycles 0..3 alone, 4 and 5 with a follower.
  EXPECT_EQ(active_in(node, {kNobody, kNobody, kNobody, kNobody, kNobody, kLeaderOnly, kLeaderOnly}), 6);
  EXPECT_EQ(node.last.reason, PocReason::kClusterStarted);
}

TEST(PocStartup, FollowingColdstartNodeIsActiveInCycle7) {
  PocScript node(coldstart_node());
  node.to_check();
  EXPECT_EQ(node.state.kind, Kind::kIntegrationColdstartCheck);
  EXPECT_EQ(active_in(node, {kNobody, kLeaderOnly, kLeaderOnly, kLeaderOnly, kLeaderOnly, kLeaderOnly}), 7);
  EXPECT_EQ(node.last.reason, PocReason::kJoined);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 4);  // following costs no attempt
}

TEST(PocStartup, FollowerSendsFromCycle4On) {
  PocScript node(coldstart_node());
  node.to_check().cycle().cycle(kLeaderOnly);
  EXPECT_EQ(mac_mode(node.state), MacMode::kNothing);  // cycle 3
  node.cycle(kLeaderOnly);
  EXPECT_EQ(node.last_cycle, 4);
  EXPECT_EQ(mac_mode(node.state), MacMode::kStartupFrame);
}

TEST(PocStartup, IntegratingNodeIsActiveInCycle8) {
  PocScript node(other_node());
  node.to_check();
  EXPECT_EQ(node.state.kind, Kind::kIntegrationConsistencyCheck);
  // 2 and 3 with the leading node alone, 4..7 with a follower too.
  EXPECT_EQ(active_in(node, {kNobody, kLeaderOnly, kLeaderOnly, kTwoNodes, kTwoNodes, kTwoNodes, kTwoNodes}), 8);
  EXPECT_EQ(node.last.reason, PocReason::kIntegrated);
}

TEST(PocStartup, LateNodesIntegrateIntoARunningCluster) {
  PocScript other(other_node());
  other.to_check();
  EXPECT_EQ(active_in(other, {kNobody, kTwoNodes, kTwoNodes, kTwoNodes, kTwoNodes}), 6);  // two double cycles
  PocScript coldstart(coldstart_node());
  coldstart.to_check();
  EXPECT_EQ(active_in(coldstart, {kNobody, kTwoNodes, kTwoNodes, kTwoNodes, kTwoNodes, kTwoNodes}), 7);
}

TEST(PocStartup, NobodyJoinsThenGapThenANewAttempt) {
  PocScript node(coldstart_node());
  node.to_consistency_check();
  EXPECT_EQ(node.last_cycle, 4);
  node.cycle(kNobody);
  EXPECT_EQ(node.state.kind, Kind::kColdstartGap);
  EXPECT_EQ(node.last.reason, PocReason::kNobodyJoined);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 2);
  EXPECT_EQ(mac_mode(node.state), MacMode::kNothing);
  node.cycle(kNobody);
  EXPECT_EQ(node.state.kind, Kind::kColdstartCollisionResolution);
  EXPECT_TRUE(node.last.actions.has(PocAction::kSendCas));
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 2);
  node.last_cycle = -1;
  EXPECT_EQ(active_in(node, {kNobody, kNobody, kNobody, kNobody, kNobody, kLeaderOnly, kLeaderOnly}), 6);
}

TEST(PocStartup, AttemptsAreExhaustedAloneOnTheBus) {
  PocScript node(coldstart_node());
  node.to_collision_resolution();
  int symbols = 1;
  for (int i = 0; i < 100 && in_startup(node.state.kind) && node.state.kind != Kind::kIntegrationListen; ++i) {
    node.cycle(kNobody);
    if (node.last.actions.has(PocAction::kSendCas)) ++symbols;
  }
  EXPECT_EQ(symbols, 4);  // gColdStartAttempts
  EXPECT_EQ(node.state.kind, Kind::kIntegrationListen);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 0);
  EXPECT_EQ(node.last.reason, PocReason::kNobodyJoined);
  EXPECT_EQ(node.last.consequence, PocReason::kAttemptsExhausted);
  EXPECT_EQ(to_text(node.last.consequence), "its coldstart attempts are exhausted: it can only join others");
  EXPECT_TRUE(node.last.actions.has(PocAction::kDropSchedule));
  // It still joins others by the coldstart path, and the host's next RUN refills the attempts.
  PocScript joining = node;
  joining.apply(PocEvent::startup_frame(kReference, 10)).apply(PocEvent::startup_frame(kReference, 11));
  EXPECT_EQ(joining.state.kind, Kind::kIntegrationColdstartCheck);
  node.apply(Event::kReady).apply(Event::kAllowColdstart).apply(Event::kRun);
  EXPECT_EQ(node.state.kind, Kind::kColdstartListen);
  EXPECT_EQ(node.state.vRemainingColdstartAttempts, 4);
}

TEST(PocStartup, CollisionLoserFollowsInTheSameCycle) {
  PocScript node(coldstart_node());
  node.to_collision_resolution().cycle();
  node.apply(Event::kHeaderReceived);
  EXPECT_EQ(node.state.kind, Kind::kColdstartListen);
  EXPECT_EQ(node.last.reason, PocReason::kCollisionHeader);
  EXPECT_TRUE(node.last.actions.has(PocAction::kDropSchedule));
  node.apply(PocEvent::startup_frame(kReference, 0));
  EXPECT_EQ(node.state.kind, Kind::kInitialiseSchedule);
  EXPECT_EQ(node.state.reference, kReference);
}

TEST(PocStartup, CollisionsUseUpAttempts) {
  PocScript node(coldstart_node());
  node.to_listen();
  for (int left = 3; left >= 2; --left) {
    node.apply(Event::kListenTimeout).apply(Event::kCasReceived);
    EXPECT_EQ(node.state.kind, Kind::kColdstartListen);
    EXPECT_EQ(node.state.vRemainingColdstartAttempts, left);
  }
  node.apply(Event::kNoiseTimeout);
  EXPECT_TRUE(node.state.coldstart_noise);
  node.apply(Event::kCasReceived);
  EXPECT_EQ(node.state.kind, Kind::kIntegrationListen);  // one left is not enough to listen for
  EXPECT_EQ(node.last.reason, PocReason::kCollisionCas);
  EXPECT_EQ(node.last.consequence, PocReason::kAttemptsExhausted);
}

TEST(PocStartup, ConsistencyCheckNeedsAPairAndAClockInOrder) {
  const auto end_of_check = [](const StartupFramesSeen& in_5, bool missing, bool limit) {
    PocScript node(coldstart_node());
    node.clock_missing = missing;
    node.clock_limit = limit;
    node.to_consistency_check().cycle(kLeaderOnly).cycle(in_5);
    return node.last;
  };
  EXPECT_EQ(end_of_check(kLeaderOnly, false, false).next.kind, Kind::kNormalActive);
  EXPECT_EQ(end_of_check(kNobody, false, false).reason, PocReason::kNoStartupPair);
  EXPECT_EQ(end_of_check({1, 0, false, false}, false, false).reason, PocReason::kNoStartupPair);
  EXPECT_EQ(end_of_check(kLeaderOnly, true, false).reason, PocReason::kStartupClockTermMissing);
  EXPECT_EQ(end_of_check(kLeaderOnly, false, true).reason, PocReason::kStartupClockLimitExceeded);
  EXPECT_EQ(end_of_check(kLeaderOnly, false, true).next.kind, Kind::kColdstartListen);
}

TEST(PocStartup, EachDoubleCycleNeedsItsOwnVerdictOnTheClock) {
  PocScript node(coldstart_node());
  node.to_join();  // the check's verdict was good
  node.apply(PocEvent::cycle_started(5, kTwoNodes)).apply(PocEvent::cycle_started(6, kTwoNodes));
  EXPECT_EQ(node.last.reason, PocReason::kStartupClockTermMissing);
  node = PocScript(other_node());
  node.to_check().cycle().cycles(2, kTwoNodes);
  node.apply(PocEvent::cycle_started(5, kTwoNodes)).apply(PocEvent::cycle_started(6, kTwoNodes));
  EXPECT_EQ(node.last.reason, PocReason::kStartupClockTermMissing);
}

TEST(PocStartup, AFollowerGivesUpWithoutStartupFramesOrAClockInOrder) {
  const StartupFramesSeen two_others{2, 2, false, false};
  const StartupFramesSeen one_other{1, 1, false, false};
  // Integration coldstart check: the node followed, or two others.
  PocScript check(coldstart_node());
  check.to_check().cycle();
  PocScript node = check;
  EXPECT_EQ(node.cycle(one_other).last.reason, PocReason::kReferenceFrameLost);
  node = check;
  EXPECT_EQ(node.cycles(2, two_others).state.kind, Kind::kColdstartJoin);
  node = check;
  EXPECT_EQ(node.cycle(kLeaderOnly).cycle(one_other).last.reason, PocReason::kReferencePairLost);
  node = check;
  node.clock_limit = true;
  EXPECT_EQ(node.cycles(2, kLeaderOnly).last.reason, PocReason::kStartupClockLimitExceeded);
  EXPECT_EQ(node.state.kind, Kind::kColdstartListen);
  // Join: another node in every even cycle, a pair in every double cycle, the clock in order.
  PocScript join(coldstart_node());
  join.to_join();
  node = join;
  EXPECT_EQ(node.cycle(kNobody).last.reason, PocReason::kJoinedAlone);
  node = join;
  EXPECT_EQ(node.cycle(one_other).cycle({1, 0, false, false}).last.reason, PocReason::kJoinedAlone);
  node = join;
  EXPECT_EQ(node.cycles(2, one_other).cycle(kNobody).last.reason, PocReason::kJoinedAlone);
  node = join;
  node.clock_missing = true;
  EXPECT_EQ(node.cycles(2, one_other).last.reason, PocReason::kStartupClockTermMissing);
  node = join;
  EXPECT_EQ(node.cycles(3, one_other).state.kind, Kind::kNormalActive);
}

TEST(PocStartup, AnIntegratingNodeGivesUpWithoutStartupFramesOrClockTerms) {
  PocScript check(other_node());
  check.to_check().cycle();
  PocScript node = check;
  EXPECT_EQ(node.cycle({1, 1, false, false}).last.reason, PocReason::kReferenceFrameLost);
  EXPECT_EQ(node.last.consequence, PocReason::kNotAColdstartNode);
  node = check;
  EXPECT_EQ(node.cycle(kLeaderOnly).cycle({1, 0, true, false}).last.reason, PocReason::kReferencePairLost);
  node = check;
  node.clock_missing = true;
  EXPECT_EQ(node.cycles(2, kTwoNodes).last.reason, PocReason::kStartupClockTermMissing);
  // After the first double cycle the node followed is not enough.
  node = check;
  EXPECT_EQ(node.cycles(3, kLeaderOnly).last.reason, PocReason::kTooFewStartupFrames);
  EXPECT_EQ(node.last_cycle, 5);
  node = check;
  EXPECT_EQ(node.cycles(2, kLeaderOnly).cycle(kTwoNodes).cycle({2, 1, true, true}).last.reason,
            PocReason::kTooFewStartupPairs);
  EXPECT_EQ(node.state.kind, Kind::kIntegrationListen);
}

TEST(PocStartup, ScheduleIsDerivedFromAnEvenAndAnOddFrameOfOneNode) {
  PocScript node(coldstart_node());
  node.to_listen().apply(PocEvent::startup_frame(3, 5));
  EXPECT_EQ(node.last.reason, PocReason::kEvenFrameAwaited);
  node.apply(PocEvent::startup_frame(3, 6));
  EXPECT_TRUE(node.last.actions.has(PocAction::kDeriveSchedule));
  EXPECT_EQ(node.state.reference, 3);
  node.apply(PocEvent::startup_frame(3, 6));  // the other channel
  EXPECT_EQ(node.last.reason, PocReason::kOddFrameAwaited);
  node.apply(PocEvent::startup_frame(4, 7));
  EXPECT_EQ(node.last.reason, PocReason::kOddFrameAwaited);
  PocScript failed = node;
  failed.apply(Event::kScheduleNotDerived);
  EXPECT_EQ(failed.state.kind, Kind::kColdstartListen);
  EXPECT_EQ(failed.state.reference, 0);
  node.apply(PocEvent::startup_frame(3, 7));
  EXPECT_EQ(node.state.kind, Kind::kIntegrationColdstartCheck);
  EXPECT_EQ(node.state.reference, 3);
}

TEST(PocStartup, ChecksBeginWithAnEvenCycle) {
  for (const PocParameters& parameters : {coldstart_node(), other_node()}) {
    PocScript node(parameters);
    node.to_check().apply(PocEvent::cycle_started(1, kNobody));
    EXPECT_EQ(node.last.reason, PocReason::kNotYetWholeCycle);
    node.apply(PocEvent::cycle_started(2, kNobody));
    EXPECT_EQ(node.last.reason, PocReason::kFirstWholeCycle);
  }
}

TEST(PocStartup, InhibitedNodeFollowsButDoesNotLead) {
  PocScript node(coldstart_node());
  node.to_ready().apply(Event::kRun);
  EXPECT_EQ(node.state.kind, Kind::kIntegrationListen);
  EXPECT_EQ(node.last.consequence, PocReason::kColdstartInhibited);
  PocScript following = node;
  following.apply(PocEvent::startup_frame(kReference, 0)).apply(PocEvent::startup_frame(kReference, 1));
  EXPECT_EQ(following.state.kind, Kind::kIntegrationColdstartCheck);
  node.apply(Event::kAllowColdstart);
  EXPECT_EQ(node.state.kind, Kind::kColdstartListen);
  EXPECT_TRUE(node.last.actions.has(PocAction::kRestartListenTimer));
  node.apply(Event::kReady);  // inhibits again
  EXPECT_EQ(node.state.kind, Kind::kReady);
  EXPECT_TRUE(node.last.actions.has(PocAction::kStopTimers));
  EXPECT_TRUE(node.state.vColdstartInhibit);
}

TEST(PocStartup, TimeoutsComeFromTheParameters) {
  EXPECT_EQ(coldstart_node().listen_timeout(), Microticks{400'000});
  EXPECT_EQ(coldstart_node().noise_timeout(), Microticks{800'000});
  schedules::model::GlobalParameters global;
  global.gListenNoise = 5;
  global.gColdStartAttempts = 7;
  global.gMaxWithoutClockCorrectionPassive = 3;
  global.gMaxWithoutClockCorrectionFatal = 9;
  schedules::model::NodeParameters node;
  node.pdListenTimeout = 1'000;
  node.pKeySlotUsedForStartup = true;
  node.pKeySlotOnlyEnabled = true;
  node.pAllowPassiveToActive = 11;
  node.pAllowHaltDueToClock = true;
  const PocParameters p = poc_parameters(global, node);
  EXPECT_EQ(p.noise_timeout(), Microticks{5'000});
  EXPECT_EQ(p.gColdStartAttempts, 7);
  EXPECT_EQ(p.gMaxWithoutClockCorrectionPassive, 3);
  EXPECT_EQ(p.gMaxWithoutClockCorrectionFatal, 9);
  EXPECT_EQ(p.pAllowPassiveToActive, 11);
  EXPECT_TRUE(p.pKeySlotUsedForStartup && p.pKeySlotOnlyEnabled && p.pAllowHaltDueToClock);
}

TEST(PocWakeup, EveryEndHasItsStatus) {
  const auto status = [](const std::vector<Event>& events) {
    PocScript node(coldstart_node());
    node.to_ready().apply(Event::kWakeup);
    for (const Event event : events) node.apply(event);
    EXPECT_EQ(node.state.kind, Kind::kReady);
    return node.state.wakeup_status;
  };
  EXPECT_EQ(status({Event::kReady}), WakeupStatus::kUndefined);
  EXPECT_EQ(status({Event::kHeaderReceived}), WakeupStatus::kReceivedHeader);
  EXPECT_EQ(status({Event::kWakeupPatternReceived}), WakeupStatus::kReceivedPattern);
  EXPECT_EQ(status({Event::kListenTimeout, Event::kWakeupSent}), WakeupStatus::kTransmitted);
  EXPECT_EQ(status({Event::kNoiseTimeout, Event::kWakeupCollision, Event::kHeaderReceived}),
            WakeupStatus::kCollisionHeader);
  EXPECT_EQ(status({Event::kListenTimeout, Event::kWakeupCollision, Event::kWakeupPatternReceived}),
            WakeupStatus::kCollisionPattern);
  EXPECT_EQ(status({Event::kListenTimeout, Event::kWakeupCollision, Event::kListenTimeout}),
            WakeupStatus::kCollisionUnknown);
}

TEST(PocWakeup, TheNextOneForgetsTheStatus) {
  PocScript node(coldstart_node());
  node.to_ready().apply(Event::kWakeup).apply(Event::kHeaderReceived).apply(Event::kWakeup);
  EXPECT_EQ(node.state.wakeup_status, WakeupStatus::kUndefined);
}

TEST(PocWakeup, LeavesColdstartInhibitAsItWas) {
  PocScript node(coldstart_node());
  node.to_ready().apply(Event::kAllowColdstart).apply(Event::kWakeup);
  node.apply(Event::kListenTimeout).apply(Event::kWakeupSent);
  EXPECT_EQ(node.state.kind, Kind::kReady);
  EXPECT_FALSE(node.state.vColdstartInhibit);
}

}  // namespace
}  // namespace ttf::bus::poc
