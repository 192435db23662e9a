// One scripted story for every kind of harm, and the same story without it.
#include "evaluation/faults/judge.h"

#include <gtest/gtest.h>

#include "evaluation/faults/reach.h"
#include "faults/plan.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::evaluation::faults {
namespace {

using recording::records::PocKind;
using recording::records::SlotStatus;
using schedules::model::Channel;

constexpr NodeId kFaulty{0}, kAlice{1}, kBob{2};
constexpr TrueTime kBegins{20'000'000};
constexpr Duration kBusCycle{5'000'000};

TrueTime in_cycle(int cycle, int us = 0) { return TrueTime{cycle * kBusCycle.ns + us * 1'000}; }

void slot_problem(FaultJudge& judge, NodeId node, SlotStatus status, TrueTime at) {
  judge.on(recording::records::SlotProblem{{at, {}, {}, node}, 0, 2, 0, status});
}

class Story : public testing::Test {
 protected:
  explicit Story(bool starts_up = false) : judge_(cluster_, settings(starts_up)) {}
  static JudgeSettings settings(bool starts_up) {
    JudgeSettings settings;
    settings.faulty = {true, false, false};
    settings.from = kBegins;
    settings.until = in_cycle(6);
    settings.assumed_precision = Duration{6'850};
    settings.starts_up = starts_up;
    return settings;
  }
  // The frame of Alice's slot on a channel.
  std::vector<std::byte> frame(Channel channel, int cycle, unsigned content) const {
    bus::wire::FrameHeader header;
    header.frame_id = 2;
    header.cycle = static_cast<std::uint8_t>(cycle);
    const std::vector<std::byte> payload(16, static_cast<std::byte>(content));
    std::vector<std::byte> bytes(bus::wire::kMaxFrameBytes);
    bytes.resize(bus::wire::encode_frame(header, channel, payload, bytes));
    return bytes;
  }
  void sends(NodeId node, int slot, Channel channel, const std::vector<std::byte>& bytes, TrueTime at) {
    judge_.frame_sent(node, slot, channel, bus::wire::decode_frame(channel, bytes), at);
  }
  void alice_sends(int cycle, unsigned content = 7) {
    for (const Channel channel : {Channel::kA, Channel::kB})
      sends(kAlice, 2, channel, frame(channel, cycle, content), in_cycle(cycle, 50));
  }
  void bob_receives(int cycle, Channel channel, unsigned content = 7) {
    const auto bytes = frame(channel, cycle, content);
    judge_.frame_received(kBob, 2, channel, bus::wire::decode_frame(channel, bytes), in_cycle(cycle, 80));
  }
  void changes(NodeId node, PocKind from, PocKind to, TrueTime at) {
    judge_.on(recording::records::StateChanged{{at, {}, {}, node}, from, to, {}, {}, {}, {}});
  }
  const Judgement& end() { return judge_.finish(in_cycle(10)); }
  const std::optional<Judgement::Harmed>& harm(Harm harm) { return end().harms[static_cast<std::size_t>(harm)]; }

  schedules::model::Cluster cluster_ = sim::engine::bus_cluster(3, 3, 3);
  FaultJudge judge_;
};

struct StartUpStory : Story {
  StartUpStory() : Story(true) {}
};

TEST_F(Story, NothingHappensAndNobodyIsHarmed) {
  for (int cycle = 0; cycle < 8; ++cycle) {
    alice_sends(cycle);
    bob_receives(cycle, Channel::kA);
    bob_receives(cycle, Channel::kB);
    judge_.precision(Duration{6'850}, in_cycle(cycle, 4'000));
  }
  EXPECT_FALSE(end().harmed());
  EXPECT_FALSE(end().detected());
}

TEST_F(Story, H1AFaultFreeNodeThatLeavesNormalActiveIsHarmed) {
  changes(kFaulty, PocKind::kNormalActive, PocKind::kHalt, in_cycle(5));
  EXPECT_FALSE(judge_.finish(in_cycle(5)).harmed()) << "the faulty one may";
  changes(kBob, PocKind::kNormalActive, PocKind::kNormalPassive, in_cycle(6));
  ASSERT_TRUE(harm(Harm::kLeftActive));
  EXPECT_EQ(harm(Harm::kLeftActive)->node, kBob);
  EXPECT_EQ(harm(Harm::kLeftActive)->first, in_cycle(6));
}

TEST_F(Story, H1WhatWasBeforeTheFaultIsNotItsHarm) {
  changes(kBob, PocKind::kNormalActive, PocKind::kNormalPassive, in_cycle(3));
  changes(kBob, PocKind::kNormalPassive, PocKind::kNormalActive, in_cycle(5));
  EXPECT_FALSE(end().harmed());
}

TEST_F(StartUpStory, H2AFaultFreeNodeThatNeverStartsIsHarmed) {
  changes(kAlice, PocKind::kColdstartJoin, PocKind::kNormalActive, in_cycle(8));
  changes(kBob, PocKind::kIntegrationListen, PocKind::kInitialiseSchedule, in_cycle(9));
  EXPECT_FALSE(judge_.all_fault_free_active());
  ASSERT_TRUE(harm(Harm::kNotStarted));
  EXPECT_EQ(harm(Harm::kNotStarted)->node, kBob);
}

TEST_F(StartUpStory, H2WhoStartsLateHasStarted) {
  changes(kAlice, PocKind::kColdstartJoin, PocKind::kNormalActive, in_cycle(8));
  changes(kBob, PocKind::kIntegrationConsistencyCheck, PocKind::kNormalActive, in_cycle(9));
  EXPECT_TRUE(judge_.all_fault_free_active());
  EXPECT_FALSE(end().harmed()) << "the faulty node does not have to";
}

TEST_F(Story, H3ClocksFurtherApartThanTheAssumedPrecisionAreHarm) {
  judge_.precision(Duration{6'851}, in_cycle(3));
  EXPECT_FALSE(judge_.finish(in_cycle(3)).harmed()) << "before the fault";
  judge_.precision(Duration{6'851}, in_cycle(5));
  ASSERT_TRUE(harm(Harm::kPrecision));
  EXPECT_EQ(harm(Harm::kPrecision)->first, in_cycle(5));
}

TEST_F(Story, H4AFrameReceivedOnOneChannelIsReceived) {
  alice_sends(5);
  bob_receives(5, Channel::kB);
  EXPECT_FALSE(end().harmed());
}

TEST_F(Story, H4AFrameReceivedOnNoChannelIsLost) {
  alice_sends(5);
  alice_sends(6);
  bob_receives(6, Channel::kA);
  ASSERT_TRUE(harm(Harm::kFrameLost));
  EXPECT_EQ(harm(Harm::kFrameLost)->node, kBob);
  EXPECT_EQ(harm(Harm::kFrameLost)->sender, kAlice);
  EXPECT_EQ(harm(Harm::kFrameLost)->frame_id, 2);
  EXPECT_EQ(harm(Harm::kFrameLost)->first, in_cycle(5, 50));
}

TEST_F(Story, H4TheLastFrameIsLostTooOnceItIsOverdue) {
  alice_sends(8);
  EXPECT_FALSE(judge_.finish(in_cycle(9)).harmed());
  EXPECT_TRUE(judge_.finish(in_cycle(11)).harmed());
}

TEST_F(Story, H4WhoIsNotNormalActiveIsOwedNothing) {
  changes(kBob, PocKind::kNormalActive, PocKind::kNormalPassive, in_cycle(3));
  alice_sends(5);
  EXPECT_FALSE(end().harmed());
}

TEST_F(Story, H4WhatTheFaultyNodeSendsIsOwedToNobody) {
  for (const Channel channel : {Channel::kA, Channel::kB})
    sends(kFaulty, 1, channel, frame(channel, 5, 7), in_cycle(5));
  EXPECT_FALSE(end().harmed());
}

TEST_F(Story, H5AFrameOfOtherContentIsForged) {
  alice_sends(5, 7);
  bob_receives(5, Channel::kA, 7);
  bob_receives(5, Channel::kB, 8);
  ASSERT_TRUE(harm(Harm::kFrameForged));
  EXPECT_EQ(harm(Harm::kFrameForged)->node, kBob);
  EXPECT_EQ(harm(Harm::kFrameForged)->sender, kAlice);
}

TEST_F(Story, H5AFrameThatWasNotSentInThisCycleIsForged) {
  alice_sends(4);
  bob_receives(4, Channel::kA);
  EXPECT_FALSE(judge_.finish(in_cycle(4, 100)).harmed());
  judge_.frame_received(kBob, 2, Channel::kA, bus::wire::decode_frame(Channel::kA, frame(Channel::kA, 4, 7)),
                        in_cycle(5, 80));
  EXPECT_TRUE(harm(Harm::kFrameForged));
}

TEST_F(Story, ChecksOfTheFaultyNodeAreKeptApart) {
  slot_problem(judge_, kBob, SlotStatus::kNoFrame, in_cycle(5));
  slot_problem(judge_, kBob, SlotStatus::kSyntaxError | SlotStatus::kBoundaryViolation, in_cycle(6));
  judge_.on(recording::records::ClockCorrected{
      .stamp = {in_cycle(7), {}, {}, kFaulty}, .rate_missing = true, .offset_limited = true});
  changes(kFaulty, PocKind::kNormalActive, PocKind::kHalt, in_cycle(7));
  judge_.on(recording::records::GuardianIntervention{.at = in_cycle(8), .why = {}});
  const auto& others = end().seen_by_others;
  const auto& itself = end().seen_by_itself;
  const auto of = [](const auto& since, Check check) { return since[static_cast<std::size_t>(check)]; };
  EXPECT_EQ(of(others, Check::kNoFrame), in_cycle(5));
  EXPECT_EQ(of(others, Check::kSyntax), in_cycle(6));
  EXPECT_EQ(of(others, Check::kBoundary), in_cycle(6));
  EXPECT_EQ(of(others, Check::kGuardian), in_cycle(8));
  EXPECT_FALSE(of(others, Check::kContent));
  EXPECT_FALSE(of(others, Check::kHalt));
  EXPECT_EQ(of(itself, Check::kMissingTerm), in_cycle(7));
  EXPECT_EQ(of(itself, Check::kLimit), in_cycle(7));
  EXPECT_EQ(of(itself, Check::kHalt), in_cycle(7));
  EXPECT_EQ(end().detected(), in_cycle(5));
  EXPECT_EQ(end().halt, in_cycle(7));
}

TEST_F(Story, ReintegrationCountsFromTheFaultsEndOrFromLeavingIfThatWasLater) {
  judge_.on(recording::records::PowerChanged{{in_cycle(5), {}, {}, kFaulty}, false});
  changes(kFaulty, PocKind::kDefaultConfig, PocKind::kConfig, in_cycle(6));
  changes(kFaulty, PocKind::kIntegrationConsistencyCheck, PocKind::kNormalActive, in_cycle(9));
  EXPECT_EQ(judge_.finish(in_cycle(9)).reintegration, kBusCycle * 3) << "the fault ended in cycle 6";
  EXPECT_EQ(end().still_out, 0);
  changes(kBob, PocKind::kNormalActive, PocKind::kNormalPassive, in_cycle(10));
  changes(kBob, PocKind::kNormalPassive, PocKind::kNormalActive, in_cycle(14));
  EXPECT_EQ(judge_.finish(in_cycle(14)).reintegration, kBusCycle * 4);
}

TEST(FaultJudge, ChecksThatFailInAFaultlessStartUpCountOnceItIsOver) {
  const schedules::model::Cluster cluster = sim::engine::bus_cluster(3, 3, 3);
  JudgeSettings settings;
  settings.faulty = {true, false, false};
  settings.settled = in_cycle(8);
  settings.usual[static_cast<std::size_t>(Check::kNoFrame)] = true;
  FaultJudge judge(cluster, settings);
  slot_problem(judge, kBob, SlotStatus::kNoFrame, in_cycle(7));
  EXPECT_FALSE(judge.finish(in_cycle(7)).detected());
  slot_problem(judge, kBob, SlotStatus::kSyntaxError, in_cycle(7));
  EXPECT_TRUE(judge.finish(in_cycle(7)).detected()) << "a check that a start-up does not show";
  slot_problem(judge, kBob, SlotStatus::kNoFrame, in_cycle(8));
  EXPECT_TRUE(judge.finish(in_cycle(8)).seen_by_others[static_cast<std::size_t>(Check::kNoFrame)]);
}

TEST(NamedBy, IsTheFaultyNodeAndWhoseSupplyItTakes) {
  const schedules::model::Cluster cluster = sim::engine::bus_cluster(4, 2, 3);
  ttf::faults::Fault fault;
  fault.kind = ttf::faults::FaultKind::kNoise;
  EXPECT_EQ(named_by(fault, cluster), (std::vector{false, false, false, false}));
  fault.kind = ttf::faults::FaultKind::kOmission;
  fault.node = NodeId{3};
  EXPECT_EQ(named_by(fault, cluster), (std::vector{false, false, false, true}));
  fault.kind = ttf::faults::FaultKind::kLoneColdstart;
  fault.node = NodeId{1};
  EXPECT_EQ(named_by(fault, cluster), (std::vector{true, true, false, false}));
  fault.all_others = true;
  EXPECT_EQ(named_by(fault, cluster), (std::vector{true, true, true, true}));
}

TEST(OwnerOf, IsWhoSendsThereInThisCycleOnThisChannel) {
  schedules::model::Cluster cluster = sim::engine::bus_cluster(3, 3, 3);
  cluster.frames.push_back({9, schedules::model::Channels::kA, 1, 4, NodeId{2}, kNoPdu, 0, 0});
  EXPECT_EQ(owner_of(cluster, 2, Channel::kB, 17), NodeId{1});
  EXPECT_EQ(owner_of(cluster, 9, Channel::kA, 5), NodeId{2});
  EXPECT_EQ(owner_of(cluster, 9, Channel::kA, 64 + 5), NodeId{2}) << "running cycles count on";
  EXPECT_EQ(owner_of(cluster, 9, Channel::kA, 6), kNoNode);
  EXPECT_EQ(owner_of(cluster, 9, Channel::kB, 5), kNoNode);
  EXPECT_EQ(owner_of(cluster, 0, Channel::kA, 5), kNoNode);
}

}  // namespace
}  // namespace ttf::evaluation::faults
