// The network management vector: its combination, its carriers, and its equality at all nodes of a cluster.
#include "bus/controller/network_management.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes(std::initializer_list<int> values) {
  Bytes made;
  for (const int value : values) made.push_back(static_cast<std::byte>(value));
  return made;
}
Bytes copy(std::span<const std::byte> vector) { return {vector.begin(), vector.end()}; }

// Three bytes of vector in all status frames (slots 1..4) and in the first slot of the list (slot 5).
schedules::model::Cluster managed(schedules::model::Cluster cluster) {
  cluster.flexray.gNetworkManagementVectorLength = 3;
  for (auto& frame : cluster.frames) frame.network_management = frame.slot <= 5;
  return cluster;
}

TEST(NetworkManagementVector, IsTheOrOfACycleShownWhenItIsOver) {
  NetworkManagement vector(2);
  EXPECT_EQ(copy(vector.combined()), bytes({0, 0}));
  vector.combine(bytes({0x01, 0x80, 0xFF}));  // bytes behind the vector do not count
  vector.combine(bytes({0x02}));              // cut off
  EXPECT_EQ(copy(vector.combined()), bytes({0, 0}));
  vector.end_cycle(true);
  EXPECT_EQ(copy(vector.combined()), bytes({0x03, 0x80}));
  vector.combine(bytes({0x10, 0}));
  vector.end_cycle(false);  // not in normal operation: stays, and is not carried over
  EXPECT_EQ(copy(vector.combined()), bytes({0x03, 0x80}));
  vector.end_cycle(true);
  EXPECT_EQ(copy(vector.combined()), bytes({0, 0}));
  vector.set_own(bytes({5, 6}));
  vector.combine(bytes({1, 1}));
  vector.end_cycle(true);
  vector.combine(bytes({1, 1}));
  vector.reset();
  EXPECT_EQ(copy(vector.combined()), bytes({0, 0}));
  EXPECT_EQ(copy(vector.own()), bytes({5, 6}));
  vector.end_cycle(true);
  EXPECT_EQ(copy(vector.combined()), bytes({0, 0}));
  EXPECT_DEATH(vector.set_own(bytes({1})), "1 bytes for a network management vector of 2");
}

TEST(NetworkManagement, StandsBeforeTheFragmentAndIsIndicated) {
  Alone node(0, managed(small_cluster(4)));
  node.controller.set_network_management_vector(bytes({0xA1, 0, 0xC3}));
  MadeList list(node.cluster.pdus[0], 1, 5, 0xABC0);  // two fragments of 8 bytes
  node.controller.outgoing(kList).write(list.view());
  node.run_to(1);
  ASSERT_EQ(node.sent_in(0).size(), 10u);
  for (const auto& sent : node.sent_in(0)) {
    const auto decoded = wire::decode_frame(sent.channel, sent.bytes);
    ASSERT_EQ(decoded.error, wire::FrameError::kNone);
    EXPECT_EQ(decoded.header.payload_preamble, sent.slot <= 5) << sent.slot;
    Bytes expected(16);
    const auto put = [&](const Bytes& what, std::size_t at) {
      std::copy(what.begin(), what.end(), expected.begin() + static_cast<std::ptrdiff_t>(at));
    };
    if (sent.slot <= 5) put(bytes({0xA1, 0, 0xC3}), 0);
    if (sent.slot == 5) put(copy(list.fragment(0)), 3);
    if (sent.slot == 6) put(copy(list.fragment(1)), 0);
    EXPECT_EQ(copy(decoded.payload), expected) << sent.slot;
  }
}

TEST(NetworkManagement, ANullFrameCarriesNone) {
  Alone node(0, managed(small_cluster(4)));
  node.controller.set_network_management_vector(bytes({0xFF, 0xFF, 0xFF}));
  node.run_to(1);
  const auto sent = node.sent_in(0);
  const auto unwritten = std::find_if(sent.begin(), sent.end(), [](const auto& frame) { return frame.slot == 5; });
  ASSERT_NE(unwritten, sent.end());
  const auto decoded = wire::decode_frame(unwritten->channel, unwritten->bytes);
  EXPECT_EQ(decoded.error, wire::FrameError::kNone);
  EXPECT_TRUE(decoded.header.null_frame);
  EXPECT_FALSE(decoded.header.payload_preamble);
  EXPECT_EQ(copy(decoded.payload), Bytes(16));
}

// Each node sets one bit; one of them changes its bit between cycles 5 and 6.
TEST(NetworkManagement, AllNodesReadTheSameOneCycleLater) {
  Rig rig(managed(small_cluster(4)), {300'000, -300'000, 0, 100'000}, Duration{500});
  for (std::size_t n = 0; n < 4; ++n) rig.controller(n).set_network_management_vector(bytes({1 << n, 0, 0x80 >> n}));
  const auto all_read = [&](const Bytes& expected) {
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(copy(rig.controller(n).network_management_vector()), expected) << n;
  };
  rig.run_until(Rig::kStart + Duration::microseconds(900));
  all_read(bytes({0, 0, 0}));
  rig.run_until(Rig::kStart + Duration::microseconds(1100));
  all_read(bytes({0x0F, 0, 0xF0}));
  rig.run_until(Rig::kStart + Duration::microseconds(5900));  // cycle 5, all status frames are out
  rig.controller(2).set_network_management_vector(bytes({0, 0x55, 0}));
  rig.run_until(Rig::kStart + Duration::microseconds(6500));
  all_read(bytes({0x0F, 0, 0xF0}));
  rig.run_until(Rig::kStart + Duration::microseconds(7500));
  all_read(bytes({0x0B, 0x55, 0xD0}));
  for (std::size_t n = 0; n < 4; ++n) EXPECT_TRUE(rig.reports(n).problems.empty());
}

TEST(NetworkManagement, OneChannelIsEnoughAndListsArriveBehindIt) {
  Rig rig(managed(small_cluster(3)), {0, 0, 0});
  rig.on_the_way = [](const TestMedium::Arrival& frame) { return frame.channel == Channel::kB; };
  rig.controller(0).set_network_management_vector(bytes({0x11, 0x22, 0x33}));
  MadeList list(rig.cluster().pdus[0], 1, 10, 500);
  rig.controller(0).outgoing(kList).write(list.view());
  rig.run_cycles(4);
  EXPECT_EQ(copy(rig.controller(1).network_management_vector()), bytes({0x11, 0x22, 0x33}));
  const auto latest = rig.controller(2).incoming(kList).latest();
  ASSERT_TRUE(latest.has_value());
  EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
}

Bytes read_after(const Frame& frame, bool damage = false) {
  Alone node(0, managed(small_cluster(4)));
  auto wire_bytes = frame.bytes();
  if (damage) wire_bytes[6] ^= std::byte{1};
  node.controller.advance({frame.start + frame.length - 1});
  node.controller.receive(received(frame.channel, {frame.start}, {frame.start + frame.length}, wire_bytes));
  node.run_to(1);
  return copy(node.controller.network_management_vector());
}

TEST(NetworkManagement, OnlyValidFramesWithTheIndicatorCount) {
  Frame frame = Frame::status(2, 0);
  frame.header.payload_preamble = true;
  std::fill_n(frame.payload.begin(), 4, std::byte{0x42});
  const Bytes silent = bytes({0, 0, 0}), said = bytes({0x42, 0x42, 0x42});
  EXPECT_EQ(read_after(frame), said);
  EXPECT_EQ(read_after(frame, true), silent);  // syntax error
  Frame plain = frame, wrong_cycle = frame, in_list = frame;
  plain.header.payload_preamble = false;
  EXPECT_EQ(read_after(plain), silent);
  wrong_cycle.header.cycle = 3;
  EXPECT_EQ(read_after(wrong_cycle), silent);  // content error
  in_list.header.frame_id = 9;                 // a slot without it in the schedule
  in_list.header.sync = in_list.header.startup = false;
  in_list.header.cycle = 1;
  in_list.start = Alone::at(1, 84 * 8 + 7).value;
  Alone node(0, managed(small_cluster(4)));
  in_list.arrive(node);
  node.run_to(2);
  EXPECT_EQ(copy(node.controller.network_management_vector()), said);
}

// The vector is hidden during start-up. A stopped node keeps it; a new schedule starts with an empty one.
TEST(NetworkManagement, IsOfNormalOperation) {
  Rig rig(managed(startup_cluster(3, 1)), {0, 0, 0, 0}, {}, std::vector<TrueTime>(4, Rig::kStart));
  for (std::size_t n = 0; n < 4; ++n) rig.controller(n).set_network_management_vector(bytes({1 << n, 0, 0}));
  bool in_startup_zero = true, someone_earlier = false;
  for (int step = 1; step < 200; ++step) {
    rig.run_until(Rig::kStart + Duration::microseconds(250) * step);
    for (std::size_t n = 0; n < 4; ++n) {
      if (!poc::in_startup(rig.controller(n).state().kind)) continue;
      in_startup_zero &= copy(rig.controller(n).network_management_vector()) == bytes({0, 0, 0});
      for (std::size_t other = 0; other < 4; ++other)
        someone_earlier |= copy(rig.controller(other).network_management_vector()) != bytes({0, 0, 0});
    }
  }
  EXPECT_TRUE(in_startup_zero);
  EXPECT_TRUE(someone_earlier);  // others spoke while the last one was still starting
  EXPECT_EQ(copy(rig.controller(3).network_management_vector()), bytes({0x0F, 0, 0}));
  rig.controller(3).command(poc::PocEventKind::kFreeze, {rig.controller(3).next_event()});
  rig.run_until(Rig::kStart + Duration::milliseconds(60));
  EXPECT_EQ(copy(rig.controller(3).network_management_vector()), bytes({0x0F, 0, 0}));
  EXPECT_EQ(copy(rig.controller(0).network_management_vector()), bytes({0x07, 0, 0}));
  rig.controller(3).start_integrated({{1'000'000'000}, 0});
  EXPECT_EQ(copy(rig.controller(3).network_management_vector()), bytes({0, 0, 0}));
}

}  // namespace
}  // namespace ttf::bus::controller
