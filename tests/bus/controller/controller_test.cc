#include "bus/controller/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/support/allocation_counter.h"

namespace ttf::bus::controller {
namespace {

TEST(ControllerSends, L3_InItsSlotsOnlyAndAlways) {
  Alone node0(0), node1(1);
  node0.run_to(4);
  node1.run_to(4);
  for (std::int64_t cycle = 0; cycle < 4; ++cycle) {
    const auto zero = node0.sent_in(cycle), one = node1.sent_in(cycle);
    ASSERT_EQ(zero.size(), 10u);  // slots 1, 5..8 on A and B
    for (std::size_t i = 0; i < zero.size(); ++i) {
      const int slot = i < 2 ? 1 : 5 + static_cast<int>(i / 2) - 1;
      EXPECT_EQ(zero[i].slot, slot);
      EXPECT_EQ(zero[i].channel, i % 2 == 0 ? Channel::kA : Channel::kB);
      EXPECT_EQ(zero[i].start, Alone::at(cycle, 84 * (slot - 1) + 7));  // at the action point
    }
    // Slot 9 on channel A in odd cycles only.
    ASSERT_EQ(one.size(), cycle % 2 == 1 ? 3u : 2u);
    if (cycle % 2 == 1) {
      EXPECT_EQ(one[2].slot, 9);
      EXPECT_EQ(one[2].channel, Channel::kA);
    }
  }
}

TEST(ControllerSends, EveryFrameIsValidOnItsChannelWithTheClustersPayloadLength) {
  Alone node;
  node.run_to(70);
  ASSERT_FALSE(node.reports.sent.empty());
  for (const auto& sent : node.reports.sent) {
    const auto decoded = wire::decode_frame(sent.channel, sent.bytes);
    ASSERT_EQ(decoded.error, wire::FrameError::kNone);
    ASSERT_EQ(decoded.header.frame_id, sent.slot);
    ASSERT_EQ(decoded.header.payload_words, 8);
    ASSERT_EQ(decoded.header.cycle, sent.cycle % 64);  // the counter wraps
    ASSERT_EQ(decoded.header.sync, sent.slot == 1);    // the key slot
    ASSERT_EQ(decoded.header.startup, sent.slot == 1);
    ASSERT_FALSE(decoded.header.payload_preamble);
    ASSERT_TRUE(std::all_of(decoded.payload.begin(), decoded.payload.end(),
                            [](std::byte byte) { return byte == std::byte{0}; }));
  }
}

TEST(ControllerSends, AStatusFrameIsNoNullFrameAndAnUnwrittenListIsOne) {
  Alone node;
  node.run_to(1);
  ASSERT_EQ(node.sent_in(0).size(), 10u);
  for (const auto& sent : node.sent_in(0)) {
    EXPECT_EQ(sent.null_frame, sent.slot != 1) << sent.slot;
    EXPECT_EQ(wire::decode_frame(sent.channel, sent.bytes).header.null_frame, sent.null_frame);
  }
}

TEST(ControllerSends, FragmentsPaddedWithZerosAndNullFramesBeyondTheList) {
  Alone node;
  MadeList list(node.cluster.pdus[0], 1, 5, 0xABC0);  // two fragments of 8 bytes
  node.controller.outgoing(kList).write(list.view());
  node.run_to(1);
  int frames = 0;
  for (const auto& sent : node.sent_in(0)) {
    if (sent.pdu != kList) continue;
    ++frames;
    EXPECT_EQ(sent.fragment, sent.slot - 5);
    EXPECT_EQ(sent.null_frame, sent.fragment >= 2);
    const auto decoded = wire::decode_frame(sent.channel, sent.bytes);
    const auto head = decoded.payload.first(8), rest = decoded.payload.last(8);
    EXPECT_TRUE(std::all_of(rest.begin(), rest.end(), [](std::byte byte) { return byte == std::byte{0}; }));
    if (sent.fragment < 2) {
      const auto expected = list.fragment(sent.fragment);
      EXPECT_TRUE(std::equal(head.begin(), head.end(), expected.begin(), expected.end()));
      EXPECT_EQ(sent.sequence, 1u);
    }
  }
  EXPECT_EQ(frames, 8) << "slots 5 to 8 on A and B";
}

TEST(ControllerSends, AListWrittenWhileItsSlotsAreSentWaitsForTheNextCycle) {
  Alone node;
  MadeList old_list(node.cluster.pdus[0], 1, 10, 100), new_list(node.cluster.pdus[0], 2, 10, 200);
  node.controller.outgoing(kList).write(old_list.view());
  node.run_to(0, 84 * 5);  // slot 5 is out, slots 6..8 are not
  node.controller.outgoing(kList).write(new_list.view());
  node.run_to(2);
  int frames = 0;
  for (const auto& sent : node.reports.sent) {
    if (sent.pdu != kList) continue;
    ++frames;
    MadeList& expected = sent.cycle == 0 ? old_list : new_list;
    const auto payload = wire::decode_frame(sent.channel, sent.bytes).payload.first(8);
    const auto fragment = expected.fragment(sent.fragment);
    EXPECT_EQ(sent.sequence, expected.sequence);
    EXPECT_TRUE(std::equal(payload.begin(), payload.end(), fragment.begin(), fragment.end())) << sent.slot;
  }
  EXPECT_EQ(frames, 2 * 8) << "slots 5 to 8 on A and B, in two cycles";
}

TEST(ControllerSends, AListWrittenAtTheActionPointOfItsFirstSlotStillGoesOut) {
  Alone node;
  node.controller.advance(Alone::at(0, 84 * 4 + 7) - Microticks{1});
  MadeList list(node.cluster.pdus[0], 6, 10, 0);
  node.controller.outgoing(kList).write(list.view());
  node.run_to(0, 84 * 5);
  ASSERT_FALSE(node.reports.sent.empty());
  EXPECT_EQ(node.reports.sent.back().sequence, 6u);
  EXPECT_FALSE(node.reports.sent.back().null_frame);
}

TEST(ControllerSends, LastIsSaidOncePerListWithItsLastFragmentOnItsLastChannel) {
  Alone node;
  for (std::uint32_t sequence = 1; sequence <= 3; ++sequence) {
    MadeList list(node.cluster.pdus[0], sequence, 7, 0);  // three fragments
    node.controller.outgoing(kList).write(list.view());
    node.run_to(4 * sequence);  // four cycles each: sent again and again
  }
  std::vector<std::uint32_t> finished;
  for (const auto& sent : node.reports.sent) {
    if (!sent.last) continue;
    finished.push_back(sent.sequence);
    EXPECT_EQ(sent.fragment, 2);
    EXPECT_EQ(sent.channel, Channel::kB);
  }
  EXPECT_EQ(finished, (std::vector<std::uint32_t>{1, 2, 3}));
}

// Base cycle and repetition refer to the cycle counter. It wraps after 5 here: cycles 5 and 6 have counters 5
// and 0.
TEST(ControllerSends, MultiplexingGoesByTheCycleCounter) {
  schedules::model::Cluster cluster = small_cluster(4);
  cluster.flexray.gCycleCountMax = 5;
  for (auto& frame : cluster.frames)
    if (frame.pdu == kOddList) frame.base_cycle = 1, frame.repetition = 4;
  Alone node(1, cluster);
  node.run_to(16);
  std::vector<std::int64_t> cycles;
  for (const auto& sent : node.reports.sent)
    if (sent.slot == 9) cycles.push_back(sent.cycle);
  EXPECT_EQ(cycles, (std::vector<std::int64_t>{1, 5, 7, 11, 13}));
}

TEST(Controller, L1_NextEventIsNeverInThePast) {
  Alone node;
  Microticks now{0};
  for (int step = 0; step < 3000; ++step) {
    const Microticks next = node.controller.next_event();
    ASSERT_GT(next, now);
    now = next + Microticks{step % 7 == 0 ? 5000 : 0};  // now and then late
    const std::int64_t cycle = node.controller.clock()->cycle();
    node.controller.advance(now);
    ASSERT_GE(node.controller.clock()->cycle(), cycle);
    ASSERT_LE(node.controller.clock()->cycle(), cycle + 1);  // no cycle is skipped
  }
  EXPECT_GT(node.controller.clock()->cycle(), 100);
}

TEST(Controller, L4_NothingAllocatesAfterConstruction) {
  struct Silent final : ControllerEvents {};
  struct SilentPort final : ports::FlexRayPort {
    void transmit(const ports::Transmission&) override {}
    bool carrier(Channel) const override { return false; }
  };
  const schedules::model::Cluster cluster = small_cluster(4);
  SilentPort port;
  Silent events;
  FlexRayController controller(cluster, NodeId{1}, port, events);
  controller.start_integrated({{1000}, 0});
  std::vector<std::vector<std::byte>> frames;
  MadeList list(cluster.pdus[0], 1, 10, 0), mine(cluster.pdus[1], 1, 3, 0);
  for (int fragment = 0; fragment < 4; ++fragment) {
    Frame frame = Frame::status(5 + fragment, 0);
    const auto payload = list.fragment(fragment);
    std::copy(payload.begin(), payload.end(), frame.payload.begin());
    frames.push_back(frame.bytes());
  }
  const auto sync = Frame::status(1, 0).bytes();
  const std::int64_t before = support::allocations();
  controller.outgoing(kOddList).write(mine.view());
  controller.advance(Alone::at(0, 80));
  controller.receive(received(Channel::kA, Alone::at(0, 7), Alone::at(0, 33), sync));
  for (int fragment = 0; fragment < 4; ++fragment) {
    const int slot_start = 84 * (4 + fragment);
    controller.advance(Alone::at(0, slot_start + 80));
    controller.receive(received(Channel::kA, Alone::at(0, slot_start + 7), Alone::at(0, slot_start + 33),
                                frames[static_cast<std::size_t>(fragment)]));
  }
  const bool complete = controller.incoming(kList).latest().has_value();
  controller.advance(Alone::at(50, 0));
  EXPECT_EQ(support::allocations(), before);
  EXPECT_TRUE(complete);
}

TEST(ControllerReceives, ListsFromBothChannels) {
  Rig rig(small_cluster(3), {0, 0, 0});
  MadeList list(rig.cluster().pdus[0], 1, 10, 500), odd(rig.cluster().pdus[1], 4, 2, 900);
  rig.controller(0).outgoing(kList).write(list.view());
  rig.controller(1).outgoing(kOddList).write(odd.view());
  rig.run_cycles(4);
  for (const std::size_t node : {1u, 2u}) {
    const auto latest = rig.controller(node).incoming(kList).latest();
    ASSERT_TRUE(latest.has_value());
    EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
    // Eight arrivals a cycle: one completes, three prepare it, all others repeat.
    int completed = 0, incomplete = 0, repeated = 0;
    for (const auto& arrived : rig.reports(node).arrived) {
      if (arrived.pdu != kList) continue;
      EXPECT_EQ(arrived.sequence, 1u);
      completed += arrived.effect == cni::ArrivalEffect::kCompleted;
      incomplete += arrived.effect == cni::ArrivalEffect::kIncomplete;
      repeated += arrived.effect == cni::ArrivalEffect::kDuplicate;
    }
    EXPECT_EQ(completed, 1);
    EXPECT_EQ(incomplete, 3);
    EXPECT_EQ(repeated, 28);
    EXPECT_TRUE(rig.reports(node).problems.empty());
  }
  EXPECT_TRUE(rig.controller(2).incoming(kOddList).latest().has_value());
  EXPECT_TRUE(rig.controller(0).incoming(kOddList).latest().has_value());
}

TEST(ControllerDeathTest, SlotsWithoutMicroticksAreOurBug) {
  schedules::model::Cluster without_slots = small_cluster(2), without_cycle = small_cluster(2);
  without_slots.flexray.gdStaticSlot = 0;
  without_cycle.flexray.gMacroPerCycle = 0;
  EXPECT_DEATH(Alone(0, without_slots), "static slots of 0 macroticks");
  EXPECT_DEATH(Alone(0, without_cycle), "static slots of 84 macroticks, 0 macroticks and 40000 microticks per cycle");
}

}  // namespace
}  // namespace ttf::bus::controller
