// The laws of the central guardian's pure part (bus/guardian/guardian.h G1 to G8,
// bus/guardian/startup_turns.h S1 to S6). They cover every node, slot, channel and cycle of a schedule, at
// the edges of every window. G9 is in guardian_ends_test.cc.
#include "bus/guardian/guardian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "bus/guardian/startup_turns.h"
#include "tests/bus/layouts.h"

namespace ttf::bus::guardian {
namespace {

using schedules::model::Channel;
using schedules::model::Channels;
using schedules::model::FrameSlot;

constexpr std::array kBoth = {Channel::kA, Channel::kB};
constexpr NodeId kFirst{0}, kSecond{1}, kThird{2}, kFourth{3};

// Four nodes in eight static slots of 43 us, twenty minislots, a symbol window; cycle multiplexing, and slots
// of one channel.
schedules::model::Cluster small() {
  schedules::model::Cluster cluster;
  schedules::model::GlobalParameters& g = cluster.flexray;
  g.gMacroPerCycle = 1000;
  g.gdStaticSlot = 43;
  g.gNumberOfStaticSlots = 8;
  g.gPayloadLengthStatic = 8;
  g.gNumberOfMinislots = 20;
  g.gdSymbolWindow = 30;
  g.gOffsetCorrectionStart = 900;
  cluster.pdus = {list_layout(), list_layout()};
  for (int n = 0; n < 4; ++n) {
    schedules::model::Node node;
    node.flexray.emplace();
    schedules::model::NodeParameters& p = *node.flexray;
    p.pMicroPerCycle = 40'000;
    p.pKeySlotId = n + 1;
    p.pKeySlotUsedForStartup = n < 2;
    p.pKeySlotUsedForSync = n < 3;
    p.pWakeupChannel = n == 1 ? Channel::kB : Channel::kA;
    p.pDelayCompensationA = p.pDelayCompensationB = 50;
    p.pLatestTx = 12;
    cluster.nodes.push_back(node);
    cluster.frames.push_back({n + 1, Channels::kAB, 0, 1, static_cast<NodeId>(n), kNoPdu, 0, 0});
  }
  cluster.frames.push_back({5, Channels::kA, 0, 2, kFirst, kNoPdu, 0, 0});
  cluster.frames.push_back({5, Channels::kA, 1, 2, kSecond, kNoPdu, 0, 0});
  cluster.frames.push_back({5, Channels::kB, 0, 1, kThird, kNoPdu, 0, 0});
  cluster.frames.push_back({7, Channels::kB, 3, 4, kFourth, kNoPdu, 0, 0});
  cluster.frames.push_back({9, Channels::kAB, 0, 1, kFourth, PduId{0}, 0, 0});  // the first dynamic slot
  cluster.frames.push_back({11, Channels::kA, 0, 2, kFirst, PduId{1}, 0, 0});
  return cluster;
}

struct Bench {
  schedules::model::Cluster cluster = small();
  std::array<schedules::model::Cluster, 2> with{guardian_cluster(cluster, Channel::kA),
                                                guardian_cluster(cluster, Channel::kB)};
  std::array<std::unique_ptr<Guardian>, 2> guardian;
  Bench() {
    for (const Channel channel : kBoth) {
      const auto c = index_of(channel);
      guardian[c] = std::make_unique<Guardian>(with[c], channel, *with[c].nodes.back().flexray);
    }
  }
  const schedules::model::GlobalParameters& g() const { return cluster.flexray; }

  // Cycle c begins at microtick 1000 + 40'000 c.
  static timebase::CycleClock clock(int cycle) {
    return {{1000, 1'000'000, 40'000, 900}, Microticks{1000 + 40'000 * cycle}, 0, cycle};
  }
  static constexpr std::int64_t kCompensation = 25;  // half of two nodes'
  static Microticks at(int cycle, std::int64_t macrotick, std::int64_t microticks = 0) {
    return {1000 + 40'000 * cycle + 40 * macrotick + kCompensation + microticks};
  }
  // As the node sends it in that slot.
  wire::DecodedFrame frame(int slot, int cycle, NodeId node) const {
    wire::DecodedFrame made;
    made.header.frame_id = static_cast<std::uint16_t>(slot);
    made.header.cycle = static_cast<std::uint8_t>(cycle);
    const bool is_static = slot <= g().gNumberOfStaticSlots;
    made.header.payload_words = static_cast<std::uint8_t>(is_static ? g().gPayloadLengthStatic : 3);
    const schedules::model::NodeParameters& p = *cluster.node(node).flexray;
    made.header.sync = slot == p.pKeySlotId && p.pKeySlotUsedForSync;
    made.header.startup = slot == p.pKeySlotId && p.pKeySlotUsedForStartup;
    return made;
  }
  GuardianAnswer ask(Channel channel, int cycle, const GuardianSignal& signal,
                     std::optional<controller::DynamicSlotCounter> counter = std::nullopt) const {
    return guardian[index_of(channel)]->judge(clock(cycle), counter ? *counter : controller::DynamicSlotCounter(g()),
                                              signal);
  }
  GuardianReason reason(Channel channel, int cycle, NodeId node, Microticks start,
                        const wire::DecodedFrame& frame) const {
    return ask(channel, cycle, {node, ports::Signal::kFrame, start, &frame}).reason;
  }
  bool owns(NodeId node, int slot, int cycle, Channel channel) const {
    return std::any_of(cluster.frames.begin(), cluster.frames.end(), [&](const FrameSlot& one) {
      return one.slot == slot && one.sender == node && includes(one.channels, channel) &&
             cycle % one.repetition == one.base_cycle;
    });
  }
};

TEST(Guardian, G1_OnlyTheScheduledNodeSendsInAStaticSlotOfItsCyclesAndChannels) {
  const Bench bench;
  int forwarded = 0;
  for (const Channel channel : kBoth)
    for (int cycle = 0; cycle < 64; ++cycle)
      for (int slot = 1; slot <= 8; ++slot)
        for (std::size_t n = 0; n < 4; ++n) {
          const auto node = static_cast<NodeId>(n);
          const GuardianReason reason =
              bench.reason(channel, cycle, node, Bench::at(cycle, 43 * (slot - 1) + 7), bench.frame(slot, cycle, node));
          const bool owns = bench.owns(node, slot, cycle, channel);
          ASSERT_EQ(reason, owns ? GuardianReason::kForwarded : GuardianReason::kNotItsSlot)
              << "slot " << slot << " cycle " << cycle << " node " << n;
          forwarded += owns;
        }
  EXPECT_EQ(forwarded, 64 * (2 * 4 + 1 + 1) + 16);
}

TEST(Guardian, G1_AHeaderThatIsNotTheSlotsIsRefused) {
  const Bench bench;
  const Microticks start = Bench::at(4, 7);
  const wire::DecodedFrame right = bench.frame(1, 4, kFirst);
  EXPECT_EQ(bench.reason(Channel::kA, 4, kFirst, start, right), GuardianReason::kForwarded);
  const auto refused = [&](auto change) {
    wire::DecodedFrame wrong = right;
    change(wrong.header);
    EXPECT_EQ(bench.reason(Channel::kA, 4, kFirst, start, wrong), GuardianReason::kWrongHeader);
  };
  refused([](wire::FrameHeader& h) { h.frame_id = 2; });
  refused([](wire::FrameHeader& h) { h.cycle = 5; });
  refused([](wire::FrameHeader& h) { h.startup = false; });
  refused([](wire::FrameHeader& h) { h.sync = h.startup = false; });
  refused([](wire::FrameHeader& h) { h.payload_words = 7; });
  // Slot 5 is not a key slot.
  wire::DecodedFrame other = bench.frame(5, 4, kFirst);
  other.header.sync = true;
  EXPECT_EQ(bench.reason(Channel::kA, 4, kFirst, Bench::at(4, 4 * 43 + 7), other), GuardianReason::kWrongHeader);
  // Null frames are frames, and a wrong frame CRC comes too late to be seen.
  wire::DecodedFrame null_frame = right;
  null_frame.header.null_frame = true;
  null_frame.error = wire::FrameError::kFrameCrc;
  EXPECT_EQ(bench.reason(Channel::kA, 4, kFirst, start, null_frame), GuardianReason::kForwarded);
}

TEST(Guardian, G2_AFrameBeginsWithinHalfAnActionPointOffset) {
  const Bench bench;
  for (const Channel channel : kBoth)
    for (const int cycle : {0, 3})
      for (const FrameSlot& slot : bench.cluster.frames) {
        if (slot.slot > 8 || !bench.owns(slot.sender, slot.slot, cycle, channel)) continue;
        const wire::DecodedFrame frame = bench.frame(slot.slot, cycle, slot.sender);
        for (std::int64_t off = -400; off <= 400; ++off) {
          const auto answer =
              bench.ask(channel, cycle,
                        {slot.sender, ports::Signal::kFrame, Bench::at(cycle, 43 * (slot.slot - 1) + 7, off), &frame});
          const bool within = off >= -140 && off <= 140;  // 3.5 us
          const bool in_slot = off >= -280;               // 7 us before lies in the slot before
          if (within) {
            ASSERT_EQ(answer.reason, GuardianReason::kForwarded) << "slot " << slot.slot << " off by " << off;
          } else if (in_slot) {
            ASSERT_EQ(answer.reason, GuardianReason::kOutsideWindow) << "slot " << slot.slot << " off by " << off;
          } else {
            ASSERT_FALSE(answer.forwards()) << "slot " << slot.slot << " off by " << off;
          }
        }
      }
}

TEST(Guardian, G3_DynamicSlotsAreCountedAndBelongToTheirNodes) {
  const Bench bench;
  const controller::MinislotGrid grid(bench.g());
  for (const Channel channel : kBoth)
    for (const int cycle : {0, 1})
      for (int minislot = 1; minislot <= 20; ++minislot)
        for (std::size_t n = 0; n < 4; ++n) {
          const auto node = static_cast<NodeId>(n);
          const int slot = 8 + minislot;  // no transmission before it
          const auto frame = bench.frame(slot, cycle, node);
          const GuardianReason reason =
              bench.reason(channel, cycle, node, Bench::at(cycle, grid.action_point(minislot).value), frame);
          ASSERT_EQ(reason,
                    bench.owns(node, slot, cycle, channel) ? GuardianReason::kForwarded : GuardianReason::kNotItsSlot)
              << "minislot " << minislot << " node " << n;
        }
  // Slot 9 took minislots 1 to 4 and an idle one, so slot 11 comes in minislot 7.
  controller::DynamicSlotCounter counter(bench.g());
  const auto clock = Bench::clock(0);
  bench.guardian[0]->count(clock, counter, Bench::at(0, grid.action_point(1).value),
                           Bench::at(0, grid.action_point(4).value));
  const auto frame = bench.frame(11, 0, kFirst);
  for (int minislot = 1; minislot <= 20; ++minislot)
    EXPECT_EQ(
        bench
            .ask(Channel::kA, 0,
                 {kFirst, ports::Signal::kFrame, Bench::at(0, grid.action_point(minislot).value), &frame}, counter)
            .forwards(),
        minislot == 7)
        << minislot;
}

// An activity under way when the segment begins has slot 9. One that began and ended before has no slot.
TEST(Guardian, G3_CountsWhatBeganBeforeTheSegmentAsNodesDo) {
  const Bench bench;
  const controller::MinislotGrid grid(bench.g());
  const auto count = [&](int cycle, Microticks start, Microticks end) {
    controller::DynamicSlotCounter counter(bench.g());
    bench.guardian[0]->count(Bench::clock(cycle), counter, start, end);
    return counter;
  };
  const auto in = [&](int minislot) { return Bench::at(1, grid.action_point(minislot).value); };
  const std::int64_t static_end = 8 * 43;
  ASSERT_GT(grid.start_of(1).value, static_end);  // something may begin between the two
  for (const Microticks start : {Bench::at(1, static_end - 20), Bench::at(1, static_end + 1), Bench::at(0, 990)}) {
    EXPECT_EQ(count(1, start, in(5)).slot_in(7), 10) << start.value;
    EXPECT_EQ(count(1, start, in(5)).slot_in(6), 0) << start.value;
    EXPECT_EQ(count(1, start, Bench::at(1, static_end + 2)).slot_in(1), 9) << start.value;
  }
  // From the cycle before, ended before this one's segment; and behind the segment.
  EXPECT_EQ(count(1, Bench::at(0, 990), Bench::at(1, 10)).slot_in(1), 9);
  EXPECT_EQ(count(1, in(20) + Microticks{400}, in(20) + Microticks{800}).slot_in(20), 28);
}

TEST(Guardian, G3_NotLaterThanPLatestTxNotLongerThanItsPduNotBeyondTheSegment) {
  Bench bench;
  const controller::MinislotGrid grid(bench.g());
  controller::DynamicSlotCounter counter(bench.g());
  const auto clock = Bench::clock(0);
  // Slot 10 was taken until minislot 11: slot 11 begins in 13, after pLatestTx.
  bench.guardian[0]->count(clock, counter, Bench::at(0, grid.action_point(2).value),
                           Bench::at(0, grid.action_point(11).value));
  auto frame = bench.frame(11, 0, kFirst);
  EXPECT_EQ(bench
                .ask(Channel::kA, 0, {kFirst, ports::Signal::kFrame, Bench::at(0, grid.action_point(13).value), &frame},
                     counter)
                .reason,
            GuardianReason::kOutsideWindow);

  auto first = bench.frame(9, 0, kFourth);
  const Microticks start = Bench::at(0, grid.action_point(1).value);
  const int words = (bench.cluster.pdus[0].fragment_bytes + 1) / 2;
  for (int length = 0; length <= 20; ++length) {
    first.header.payload_words = static_cast<std::uint8_t>(length);
    EXPECT_EQ(bench.reason(Channel::kA, 0, kFourth, start, first),
              length <= words + 1 ? GuardianReason::kForwarded : GuardianReason::kWrongHeader)
        << length;
  }
  first.header.payload_words = 3;
  first.header.sync = true;
  EXPECT_EQ(bench.reason(Channel::kA, 0, kFourth, start, first), GuardianReason::kWrongHeader);
  first.header.sync = false;
  const auto answer = bench.ask(Channel::kA, 0, {kFourth, ports::Signal::kFrame, start, &first});
  EXPECT_GE(answer.until,
            start + Microticks{4 * schedules::model::frame_bits(bench.g(), 3) + 40 * bench.g().gdMinislot});
  EXPECT_LE(answer.until, Bench::at(0, grid.start_of(21).value));
}

TEST(Guardian, G4_AMediaAccessTestSymbolInTheSymbolWindowOnly) {
  const Bench bench;
  const std::int64_t window = 8 * 43 + 4 + 20 * 5;
  for (const Channel channel : kBoth)
    for (std::size_t n = 0; n < 4; ++n)
      for (std::int64_t macrotick = 0; macrotick < 1000; ++macrotick) {
        const auto answer =
            bench.ask(channel, 2, {static_cast<NodeId>(n), ports::Signal::kCas, Bench::at(2, macrotick), nullptr});
        const bool in_window = macrotick >= window && macrotick < window + 30;
        ASSERT_EQ(answer.reason, in_window ? GuardianReason::kForwarded : GuardianReason::kNoSymbolNow) << macrotick;
        if (in_window) {
          ASSERT_LE(answer.until, Bench::at(2, window + 30));
        }
        ASSERT_FALSE(
            bench.ask(channel, 2, {static_cast<NodeId>(n), ports::Signal::kWakeup, Bench::at(2, macrotick), nullptr})
                .forwards());
      }
}

TEST(Guardian, G5_NothingBetweenTheSegmentsAndNothingThatIsNotMadeOut) {
  const Bench bench;
  auto frame = bench.frame(1, 0, kFirst);
  for (std::int64_t macrotick = 8 * 43 + 4 + 20 * 5; macrotick < 1000; ++macrotick)
    ASSERT_EQ(bench.reason(Channel::kA, 0, kFirst, Bench::at(0, macrotick), frame), GuardianReason::kNobodysTime);
  EXPECT_EQ(bench.reason(Channel::kA, 0, kFirst, Bench::at(0, 0, -1), frame), GuardianReason::kNobodysTime);
  EXPECT_EQ(bench.ask(Channel::kA, 0, {kFirst, ports::Signal::kUndecodable, Bench::at(0, 7), nullptr}).reason,
            GuardianReason::kUndecodable);
  for (const auto error : {wire::FrameError::kTooShort, wire::FrameError::kHeaderCrc}) {
    frame.error = error;
    EXPECT_EQ(bench.reason(Channel::kA, 0, kFirst, Bench::at(0, 7), frame), GuardianReason::kUndecodable);
  }
}

TEST(Guardian, G7_AFrameMayLastAsLongAsASlowNodesAndEndsInItsSlot) {
  const Bench bench;
  const auto frame = bench.frame(3, 0, kThird);
  const std::int64_t bits = schedules::model::frame_bits(bench.g(), 8);
  for (std::int64_t off = -140; off <= 140; off += 20) {
    const Microticks start = Bench::at(0, 2 * 43 + 7, off);
    const auto answer = bench.ask(Channel::kB, 0, {kThird, ports::Signal::kFrame, start, &frame});
    EXPECT_GE((answer.until - start).value, 4 * bits + 4 * bits * 3 / 1000);
    EXPECT_LE(answer.until, Bench::at(0, 3 * 43 - 3));  // half an action point offset before the slot's end
  }
}

TEST(Guardian, ReasonsHaveWords) {
  for (const GuardianReason a : kAllGuardianReasons)
    for (const GuardianReason b : kAllGuardianReasons) EXPECT_EQ(to_text(a) == to_text(b), a == b);
}

// ---- without a schedule

struct Startup : Bench {
  std::array<StartupTurns, 2> turns{StartupTurns(with[0], Channel::kA, *with[0].nodes.back().flexray),
                                    StartupTurns(with[1], Channel::kB, *with[1].nodes.back().flexray)};
  wire::DecodedFrame made;
  static Microticks cycles(double count) { return {static_cast<std::int64_t>(40'000 * count)}; }
  GuardianSignal symbol(NodeId node, double at, ports::Signal kind = ports::Signal::kCas) const {
    return {node, kind, cycles(at), nullptr};
  }
  GuardianSignal startup_frame(NodeId node, double at, int cycle = 0) {
    made = frame(cluster.node(node).flexray->pKeySlotId, cycle, node);
    return {node, ports::Signal::kFrame, cycles(at), &made};
  }
  GuardianReason reason(const GuardianSignal& signal, Channel channel = Channel::kA) const {
    return turns[index_of(channel)].judge(signal).reason;
  }
  // Asks, and forwards if allowed.
  GuardianReason pass(const GuardianSignal& signal, bool has_schedule = false) {
    const GuardianReason answer = has_schedule ? GuardianReason::kForwarded : reason(signal);
    if (answer == GuardianReason::kForwarded) turns[0].forwarded(signal, has_schedule);
    return answer;
  }
};

TEST(GuardianStartupTurns, G6_OnlyColdstartNodesSendSymbolsAndStartupFrames) {
  Startup s;
  for (const NodeId node : {kFirst, kSecond, kThird, kFourth}) {
    const bool coldstart = node == kFirst || node == kSecond;
    const auto expected = coldstart ? GuardianReason::kForwarded : GuardianReason::kNoColdstartNode;
    EXPECT_EQ(s.reason(s.symbol(node, 1.0)), expected);
    EXPECT_EQ(s.reason(s.startup_frame(node, 1.0)), expected);
  }
  EXPECT_EQ(s.reason(s.symbol(kFirst, 1.0, ports::Signal::kUndecodable)), GuardianReason::kUndecodable);
  auto wrong = [&](auto change) {
    GuardianSignal signal = s.startup_frame(kFirst, 1.0);
    change(s.made);
    return s.reason(signal);
  };
  EXPECT_EQ(wrong([](auto& f) { f.header.frame_id = 2; }), GuardianReason::kNoStartupFrame);
  EXPECT_EQ(wrong([](auto& f) { f.header.startup = false; }), GuardianReason::kNoStartupFrame);
  EXPECT_EQ(wrong([](auto& f) { f.header.sync = false; }), GuardianReason::kNoStartupFrame);
  EXPECT_EQ(wrong([](auto& f) { f.header.payload_words = 4; }), GuardianReason::kNoStartupFrame);
  EXPECT_EQ(wrong([](auto& f) { f.error = wire::FrameError::kHeaderCrc; }), GuardianReason::kUndecodable);
}

TEST(GuardianStartupTurns, S1_OneLeadsAtATime) {
  Startup s;
  EXPECT_EQ(s.pass(s.symbol(kFirst, 1.0)), GuardianReason::kForwarded);
  EXPECT_EQ(s.turns[0].leader(), kFirst);
  EXPECT_EQ(s.pass(s.symbol(kSecond, 1.01)), GuardianReason::kOtherLeads);
  EXPECT_EQ(s.pass(s.startup_frame(kSecond, 1.5)), GuardianReason::kOtherLeads);
  EXPECT_EQ(s.pass(s.symbol(kSecond, 1.5, ports::Signal::kWakeup)), GuardianReason::kNoWakeup);
  EXPECT_EQ(s.pass(s.startup_frame(kFirst, 1.02)), GuardianReason::kForwarded);
  EXPECT_EQ(s.turns[0].leader(), kFirst);
  // The leader is not received for more than a cycle.
  EXPECT_EQ(s.pass(s.startup_frame(kSecond, 2.0)), GuardianReason::kOtherLeads);
  EXPECT_EQ(s.pass(s.startup_frame(kSecond, 2.1)), GuardianReason::kForwarded);
  EXPECT_EQ(s.turns[0].leader(), kSecond);
}

TEST(GuardianStartupTurns, S2_OneFrameInACycleAndNoSecondSymbol) {
  Startup s;
  EXPECT_EQ(s.pass(s.symbol(kFirst, 1.0)), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 1.01)), GuardianReason::kTooSoon);
  EXPECT_EQ(s.pass(s.startup_frame(kFirst, 1.02)), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.startup_frame(kFirst, 1.5)), GuardianReason::kTooSoon);
  EXPECT_EQ(s.pass(s.startup_frame(kFirst, 2.017, 1)), GuardianReason::kForwarded);  // a clock may be fast
}

TEST(GuardianStartupTurns, S3_ALeadThatCameToNothingIsNotSoonRepeated) {
  Startup s;
  EXPECT_EQ(s.pass(s.symbol(kFirst, 1.0)), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 3.0)), GuardianReason::kLeadFailed);
  EXPECT_EQ(s.pass(s.symbol(kSecond, 3.0)), GuardianReason::kForwarded);  // others may
  EXPECT_EQ(s.pass(s.symbol(kFirst, 13.9)), GuardianReason::kLeadFailed);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 14.2)), GuardianReason::kForwarded);
  // Endless frames without a derivable schedule.
  Startup endless;
  int passed = 0;
  for (int n = 0; n < 10; ++n)
    passed += endless.pass(endless.startup_frame(kFirst, 1.0 + n)) == GuardianReason::kForwarded;
  EXPECT_EQ(passed, StartupTurns::kLeadCycles);
  // A schedule that was taken and dropped.
  Startup dropped;
  dropped.pass(dropped.startup_frame(kFirst, 1.0));
  dropped.turns[0].schedule_dropped(Startup::cycles(3.0));
  EXPECT_EQ(dropped.reason(dropped.startup_frame(kFirst, 14.9)), GuardianReason::kLeadFailed);
  EXPECT_EQ(dropped.reason(dropped.startup_frame(kFirst, 15.0)), GuardianReason::kForwarded);
}

TEST(GuardianStartupTurns, S4_WhoLedAsItShouldWaitsForTheSilentCycleOnly) {
  for (const bool as_it_should : {true, false}) {
    Startup s;
    s.pass(s.symbol(kFirst, 0.99));
    for (int cycle = 0; cycle < (as_it_should ? 5 : 4); ++cycle)
      s.pass(s.startup_frame(kFirst, 1.01 + cycle, cycle), cycle >= 2);
    s.turns[0].schedule_dropped(Startup::cycles(6.0));  // the end of its cycle 4
    EXPECT_EQ(s.reason(s.symbol(kFirst, 6.5)), GuardianReason::kLeadFailed);
    EXPECT_EQ(s.reason(s.symbol(kFirst, 7.0)), as_it_should ? GuardianReason::kForwarded : GuardianReason::kLeadFailed);
  }
  // Refused without the symbol, and with a frame that is missing or of another cycle.
  Startup middle;
  for (int cycle = 0; cycle < 5; ++cycle) middle.pass(middle.startup_frame(kFirst, 1.0 + cycle, cycle), cycle >= 2);
  middle.turns[0].schedule_dropped(Startup::cycles(6.0));
  EXPECT_EQ(middle.reason(middle.symbol(kFirst, 7.0)), GuardianReason::kLeadFailed);
  Startup wrong;
  wrong.pass(wrong.symbol(kFirst, 0.99));
  for (int cycle = 0; cycle < 5; ++cycle)
    wrong.pass(wrong.startup_frame(kFirst, 1.01 + cycle, cycle == 3 ? 4 : cycle), cycle >= 2);
  wrong.turns[0].schedule_dropped(Startup::cycles(6.0));
  EXPECT_EQ(wrong.reason(wrong.symbol(kFirst, 7.0)), GuardianReason::kLeadFailed);
}

TEST(GuardianStartupTurns, S5_AWakeupPatternOnItsChannelOnceInAWhile) {
  Startup s;
  EXPECT_EQ(s.reason(s.symbol(kFirst, 1.0, ports::Signal::kWakeup), Channel::kB), GuardianReason::kNoWakeup);
  EXPECT_EQ(s.reason(s.symbol(kSecond, 1.0, ports::Signal::kWakeup), Channel::kB), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 1.0, ports::Signal::kWakeup)), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 12.9, ports::Signal::kWakeup)), GuardianReason::kNoWakeup);
  EXPECT_EQ(s.pass(s.symbol(kFourth, 2.0, ports::Signal::kWakeup)), GuardianReason::kForwarded);
  EXPECT_EQ(s.pass(s.symbol(kFirst, 13.0, ports::Signal::kWakeup)), GuardianReason::kForwarded);
  EXPECT_EQ(s.turns[0].leader(), kNoNode);
  s.pass(s.symbol(kSecond, 14.0));
  EXPECT_EQ(s.pass(s.symbol(kThird, 14.1, ports::Signal::kWakeup)), GuardianReason::kOtherLeads);
}

TEST(GuardianStartupTurns, S6_NothingLastsLongerThanItMay) {
  Startup s;
  const auto length = [&](const GuardianSignal& signal) {
    return (s.turns[0].judge(signal).until - signal.start).value;
  };
  EXPECT_NEAR(static_cast<double>(length(s.symbol(kFirst, 1.0))), 4.0 * 91, 8.0);
  EXPECT_NEAR(static_cast<double>(length(s.startup_frame(kFirst, 1.0))), 4.0 * schedules::model::frame_bits(s.g(), 8),
              10.0);
  EXPECT_NEAR(static_cast<double>(length(s.symbol(kFirst, 1.0, ports::Signal::kWakeup))), 4.0 * 2 * 240, 12.0);
}

TEST(GuardianStartupTurns, AfterTheClusterHasStartedNobodyLeads) {
  Startup s;
  s.pass(s.symbol(kFirst, 1.0));
  s.turns[0].synchronised();
  EXPECT_EQ(s.turns[0].leader(), kNoNode);
  s.pass(s.symbol(kFirst, 2.0));
  s.pass(s.symbol(kFirst, 4.0));
  s.turns[0].reset();
  EXPECT_EQ(s.reason(s.symbol(kFirst, 4.1)), GuardianReason::kForwarded);
}

}  // namespace
}  // namespace ttf::bus::guardian
