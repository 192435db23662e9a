// The sender in a dynamic slot: by cycle, by channel, by message id. In key slot only mode there is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/bus/dynamic_cluster.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channels;

schedules::model::FrameSlot& dynamic_slot(schedules::model::Cluster& cluster, int node) {
  return *std::find_if(cluster.frames.begin(), cluster.frames.end(),
                       [&](const auto& frame) { return frame.slot == 11 + node; });
}

std::vector<std::int64_t> cycles_of(Rig& rig, std::size_t node, Channel channel = Channel::kA) {
  std::vector<std::int64_t> cycles;
  for (const auto& sent : dynamic_frames(rig, node, channel)) cycles.push_back(sent.cycle);
  return cycles;
}

void expect_no_problems(Rig& rig, std::size_t nodes) {
  for (std::size_t n = 0; n < nodes; ++n) EXPECT_TRUE(rig.reports(n).problems.empty()) << n;
}

// Slot 11 is node 0's in cycles 1, 5, 9.. and node 1's in even ones. Both have new data in every cycle.
TEST(DynamicMultiplexing, ASlotIsSharedByBaseCycleAndRepetition) {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  dynamic_slot(cluster, 0).base_cycle = 1;
  dynamic_slot(cluster, 0).repetition = 4;
  schedules::model::FrameSlot& other = dynamic_slot(cluster, 1);
  other.slot = 11;
  other.repetition = 2;
  Rig rig(cluster, {0, 0, 0});
  for (int cycle = 0; cycle < 12; ++cycle) {
    for (const std::size_t node : {0u, 1u}) write(rig, node, static_cast<std::uint32_t>(cycle) + 1);
    rig.run_cycles(cycle + 1);
  }
  EXPECT_EQ(cycles_of(rig, 0), (std::vector<std::int64_t>{1, 5, 9}));
  EXPECT_EQ(cycles_of(rig, 1), (std::vector<std::int64_t>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(arrived(rig, 2, PduId{2}), (std::vector<std::uint32_t>{2, 6, 10}));
  EXPECT_EQ(arrived(rig, 2, PduId{3}), (std::vector<std::uint32_t>{1, 3, 5, 7, 9, 11}));
  expect_no_problems(rig, 3);
}

// A frame with the right id in a cycle that is not its own belongs to no node. Its header is right, so it is valid.
TEST(DynamicMultiplexing, TheWrongCycleIsUnexpected) {
  schedules::model::Cluster cluster = dynamic_cluster(2);
  dynamic_slot(cluster, 1).base_cycle = 1;
  dynamic_slot(cluster, 1).repetition = 2;
  for (const std::int64_t cycle : {0, 1}) {
    Alone node(0, cluster);
    Frame frame;
    frame.header.frame_id = 12;
    frame.header.cycle = static_cast<std::uint8_t>(cycle);
    frame.payload.resize(8);
    const MadeList list(cluster.pdus[3], 1, 3, 0);
    std::copy(list.bytes.begin(), list.bytes.end(), frame.payload.begin());
    frame.start = Alone::at(cycle, kSegment + 5 + 3).value;  // in minislot 2
    frame.length = 17 * 40;
    node.run_to(cycle, 841);
    node.reports.problems.clear();
    frame.arrive(node);
    ASSERT_EQ(node.reports.problems.size(), cycle == 0 ? 1u : 0u);
    if (cycle == 0) {
      EXPECT_EQ(node.reports.problems[0].status, kUnexpectedFrame);
    }
    EXPECT_EQ(node.reports.arrived.size(), cycle == 0 ? 0u : 1u);
  }
}

// Slot 11 is node 0's on A and node 1's on B, in the same cycles.
TEST(DynamicMultiplexing, TheChannelsBelongToDifferentNodes) {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  dynamic_slot(cluster, 0).channels = Channels::kA;
  schedules::model::FrameSlot& other = dynamic_slot(cluster, 1);
  other.slot = 11;
  other.channels = Channels::kB;
  Rig rig(cluster, {100'000, -100'000, 0}, Duration{500});
  rig.run_cycles(10);
  for (int cycle = 10; cycle < 20; ++cycle) {
    for (const std::size_t node : {0u, 1u}) write(rig, node, static_cast<std::uint32_t>(cycle));
    rig.run_cycles(cycle + 1);
  }
  EXPECT_EQ(cycles_of(rig, 0, Channel::kA), cycles_of(rig, 1, Channel::kB));
  EXPECT_EQ(cycles_of(rig, 0, Channel::kA).size(), 10u);
  EXPECT_TRUE(cycles_of(rig, 0, Channel::kB).empty());
  EXPECT_TRUE(cycles_of(rig, 1, Channel::kA).empty());
  EXPECT_EQ(arrived(rig, 2, PduId{2}).size(), 10u);
  EXPECT_EQ(arrived(rig, 2, PduId{3}).size(), 10u);
  expect_no_problems(rig, 3);
}

// Slot 5 belongs to node 0 on A and to node 1 on B; slot 9 belongs to two nodes by cycle.
TEST(StaticMultiplexing, ChannelsAndCyclesOfASlotBelongToDifferentNodes) {
  schedules::model::Cluster cluster = small_cluster(3);
  std::erase_if(cluster.frames, [](const auto& frame) { return frame.slot > 4; });
  cluster.pdus = {list_layout(4, 3, 3), list_layout(4, 3, 3), list_layout(4, 3, 3)};
  cluster.frames.push_back({5, Channels::kA, 0, 1, NodeId{0}, PduId{0}, 0, 0});
  cluster.frames.push_back({5, Channels::kB, 0, 1, NodeId{1}, PduId{1}, 0, 0});
  cluster.frames.push_back({9, Channels::kAB, 0, 4, NodeId{0}, PduId{0}, 0, 0});
  cluster.frames.push_back({9, Channels::kAB, 3, 4, NodeId{2}, PduId{2}, 0, 0});
  Rig rig(cluster, {0, 0, 0});
  for (std::size_t node = 0; node < 3; ++node) {
    const MadeList list(rig.cluster().pdus[node], 1, 3, 0);
    rig.controller(node).outgoing(static_cast<PduId>(node)).write(list.view());
  }
  rig.run_cycles(9);
  const auto sent = [&](std::size_t node, int slot, Channel channel) {
    std::vector<std::int64_t> cycles;
    for (const auto& frame : rig.reports(node).sent)
      if (frame.slot == slot && frame.channel == channel) cycles.push_back(frame.cycle);
    return cycles;
  };
  const std::vector<std::int64_t> every{0, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(sent(0, 5, Channel::kA), every);
  EXPECT_TRUE(sent(0, 5, Channel::kB).empty());
  EXPECT_EQ(sent(1, 5, Channel::kB), every);
  EXPECT_TRUE(sent(1, 5, Channel::kA).empty());
  EXPECT_EQ(sent(0, 9, Channel::kB), (std::vector<std::int64_t>{0, 4, 8}));
  EXPECT_EQ(sent(2, 9, Channel::kA), (std::vector<std::int64_t>{3, 7}));
  expect_no_problems(rig, 3);
}

// Only the key slot is sent, in both segments, until ALL_SLOTS takes effect at a cycle start.
TEST(KeySlotOnlyMode, HoldsInBothSegments) {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  cluster.nodes[0].flexray->pKeySlotOnlyEnabled = true;
  Rig rig(cluster, {0, 0, 0});
  MadeList list(rig.cluster().pdus[0], 1, 10, 0);
  rig.controller(0).outgoing(kList).write(list.view());
  write(rig, 0, 1);
  rig.run_cycles(4);
  for (const auto& sent : rig.reports(0).sent) EXPECT_EQ(sent.slot, 1);
  EXPECT_EQ(rig.reports(0).sent.size(), 8u);  // four cycles, two channels
  const TrueTime middle = Rig::kStart + Duration::microseconds(4'020);
  rig.run_until(middle);
  rig.controller(0).command(poc::PocEventKind::kAllSlots, {middle.ns / 25});
  rig.run_cycles(6);
  std::vector<int> in_cycle_4, in_cycle_5;
  for (const auto& sent : rig.reports(0).sent) {
    if (sent.channel != Channel::kA) continue;
    if (sent.cycle == 4) in_cycle_4.push_back(sent.slot);
    if (sent.cycle == 5) in_cycle_5.push_back(sent.slot);
  }
  EXPECT_EQ(in_cycle_4, std::vector<int>{1});
  EXPECT_EQ(in_cycle_5, (std::vector<int>{1, 5, 6, 7, 8, 11}));
  EXPECT_EQ(arrived(rig, 1, PduId{2}), std::vector<std::uint32_t>{1});
}

// Two lists of node 1 share slot 12 and are distinguished by message id; node 0's slot 11 has no id.
schedules::model::Cluster with_message_ids() {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  dynamic_slot(cluster, 1).message_id = 0x1234;
  schedules::model::FrameSlot second = dynamic_slot(cluster, 1);
  second.message_id = 0xFEDC;
  second.pdu = static_cast<PduId>(cluster.pdus.size());
  cluster.pdus.push_back(list_layout(4, 3, 3));
  cluster.frames.push_back(second);
  return cluster;
}

TEST(MessageId, StandsFirstInThePayloadAndSeparatesLists) {
  Rig rig(with_message_ids(), {0, 0, 0});
  const MadeList list(rig.cluster().pdus[5], 9, 3, 700);
  rig.run_cycles(2);
  write(rig, 1, 4);
  rig.controller(1).outgoing(PduId{5}).write(list.view());
  rig.run_cycles(6);
  const auto sent = dynamic_frames(rig, 1);
  ASSERT_EQ(sent.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto decoded = wire::decode_frame(Channel::kA, sent[i].bytes);
    EXPECT_EQ(decoded.error, wire::FrameError::kNone);
    EXPECT_TRUE(decoded.header.payload_preamble);
    EXPECT_EQ(decoded.payload.size(), 10u);
    EXPECT_EQ(decoded.payload[0], i == 0 ? std::byte{0x12} : std::byte{0xFE});
    EXPECT_EQ(decoded.payload[1], i == 0 ? std::byte{0x34} : std::byte{0xDC});
    EXPECT_EQ(wire::message_id(decoded), i == 0 ? 0x1234 : 0xFEDC);
    EXPECT_EQ(sent[i].cycle, 2 + static_cast<std::int64_t>(i));  // one slot, one frame a cycle
  }
  for (const std::size_t node : {0u, 2u}) {
    EXPECT_EQ(arrived(rig, node, PduId{3}), std::vector<std::uint32_t>{4});
    const auto latest = rig.controller(node).incoming(PduId{5}).latest();
    ASSERT_TRUE(latest.has_value());
    EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
  }
  expect_no_problems(rig, 3);
}

TEST(MessageId, AnUnknownMissingOrUnexpectedOneMakesTheFrameUnexpected) {
  struct Case {
    int slot;
    bool preamble;
    std::vector<int> first;
    SlotStatus status;
  };
  for (const Case& one : {Case{12, true, {0x12, 0x34}, kValidFrame}, Case{12, true, {0x34, 0x12}, kUnexpectedFrame},
                          Case{12, false, {}, kUnexpectedFrame}, Case{12, false, {0x12, 0x34}, kUnexpectedFrame},
                          Case{13, false, {}, kValidFrame}, Case{13, true, {0x12, 0x34}, kUnexpectedFrame}}) {
    Alone node(0, with_message_ids());
    const MadeList list(node.cluster.pdus[one.slot == 12 ? 3 : 4], 1, 3, 0);
    Frame frame;
    frame.header.frame_id = static_cast<std::uint16_t>(one.slot);
    frame.header.payload_preamble = one.preamble;
    frame.payload.clear();
    for (const int value : one.first) frame.payload.push_back(static_cast<std::byte>(value));
    frame.payload.insert(frame.payload.end(), list.bytes.begin(), list.bytes.end());
    frame.start = Alone::at(0, kSegment + 5 * (one.slot - 11) + 3).value;
    frame.length = 18 * 40;
    node.run_to(0, 841);
    node.reports.problems.clear();
    frame.arrive(node);
    const SlotStatus status = node.reports.problems.empty() ? kValidFrame : node.reports.problems[0].status;
    EXPECT_EQ(status, one.status) << one.slot << (one.preamble ? " with" : " without");
    EXPECT_EQ(node.reports.arrived.size(), one.status == kValidFrame ? 1u : 0u);
  }
}

TEST(MessageId, NeedsTwoBytes) {
  wire::DecodedFrame frame;
  frame.header.payload_preamble = true;
  EXPECT_FALSE(wire::message_id(frame).has_value());
  const std::vector<std::byte> payload{std::byte{0x80}, std::byte{0x01}};
  frame.payload = payload;
  EXPECT_EQ(wire::message_id(frame), 0x8001);
  frame.header.payload_preamble = false;
  EXPECT_FALSE(wire::message_id(frame).has_value());
}

}  // namespace
}  // namespace ttf::bus::controller
