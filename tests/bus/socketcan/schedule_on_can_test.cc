// Schedules on real CAN FD, against bits counted here field by field. Stuff bits are maximised over all
// choices of bits. Also against frames of drawn contents, which never last longer.
#include "bus/socketcan/schedule_on_can.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bus/wire/can_timing.h"
#include "schedules/check/checker.h"
#include "schedules/check/real_time_rules.h"
#include "tests/bus/socketcan/frames.h"

namespace ttf::bus::socketcan {
namespace {

using schedules::model::Channels;
using schedules::model::Cluster;

constexpr BitRates kFast{1'000'000, 5'000'000};
constexpr std::int64_t kOne = schedules::check::kTimeScaleOne;

// The most stuff bits that n free bits can need: a stuff bit follows five equal ones, stuff bits included.
int most_stuff_bits(int n) {
  constexpr int kNever = -1000;
  std::array<int, 6> best{};  // by the run's length so far; which value it has does not matter
  best.fill(kNever);
  best[1] = 0;
  for (int bit = 1; bit < n; ++bit) {
    std::array<int, 6> next{};
    next.fill(kNever);
    for (int run = 1; run <= 4; ++run) {
      next[1] = std::max(next[1], best[static_cast<std::size_t>(run)]);
      if (run < 4)
        next[static_cast<std::size_t>(run) + 1] = best[static_cast<std::size_t>(run)];
      else
        next[1] = std::max(next[1], best[4] + 1);  // the fifth; the stuff bit begins a new run
    }
    best = next;
  }
  return *std::ranges::max_element(best);
}

// The data rate must divide a billion, so that all durations are whole nanoseconds.
Duration longest(int data_bytes, BitRates rates) {
  const int sof = 1, identifier = 11, rrs = 1, ide = 1, fdf = 1, res = 1, brs = 1;
  const int esi = 1, dlc = 4, stuff_count = 4, crc = data_bytes > 16 ? 21 : 17;
  const int crc_delimiter = 1, ack = 2, end_of_frame = 7, intermission = 3;
  const int fixed_stuff_bits = (stuff_count + crc + 3) / 4;  // in front of each four bits
  const int nominal = sof + identifier + rrs + ide + fdf + res + brs + most_stuff_bits(sof + identifier + rrs + ide) +
                      crc_delimiter + ack + end_of_frame + intermission;
  const int data = esi + dlc + 8 * data_bytes + most_stuff_bits(brs + esi + dlc + 8 * data_bytes) + stuff_count + crc +
                   fixed_stuff_bits;
  return {nominal * (1'000'000'000 / rates.nominal) + data * (1'000'000'000 / rates.data)};
}

Cluster shipped(const std::string& name) {
  return schedules::check::load_checked_cluster(TTF_SOURCE_DIR "/schedules/" + name + ".yaml");
}

// A sync node with slot 1 on both channels, and a payload of so many words.
Cluster with_payload(int words) {
  Cluster cluster;
  cluster.flexray.gNumberOfStaticSlots = 10;
  cluster.flexray.gPayloadLengthStatic = words;
  cluster.nodes.resize(2);
  for (schedules::model::Node& node : cluster.nodes) node.flexray.emplace();
  cluster.frames = {{1, Channels::kAB, 0, 1, NodeId{0}, kNoPdu, 0, 0}};
  return cluster;
}

TEST(ScheduleOnCan, StuffBitsAreCountedAsKnown) {
  EXPECT_EQ(most_stuff_bits(4), 0);
  EXPECT_EQ(most_stuff_bits(5), 1);
  EXPECT_EQ(most_stuff_bits(8), 1);
  EXPECT_EQ(most_stuff_bits(9), 2);
  // By hand: 17 + 3 + 13 bits at 1 us; 5 + 512 + 129 + 4 + 21 + 7 at 0.2 us.
  EXPECT_EQ(longest(64, kFast), Duration{33'000 + 678 * 200});
}

// 56 bytes of payload: one CAN FD frame of 64. Slots 1..5 are those of sync frames, with a follow-up of 12
// bytes: 33 us and (5 + 96 + 25 + 4 + 17 + 6) 0.2 us.
TEST(ScheduleOnCan, ThePapersSlots) {
  const auto slots = slots_on_can(shipped("paper_synchronised"), kFast);
  ASSERT_EQ(slots.size(), 34u);
  const Duration follow_up{33'000 + 153 * 200};
  EXPECT_EQ(longest(12, kFast), follow_up);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    EXPECT_EQ(slots[i].slot, static_cast<int>(i) + 1);
    EXPECT_EQ(slots[i].channels, Channels::kAB);
    EXPECT_FALSE(slots[i].dynamic);
    EXPECT_EQ(slots[i].frame, Duration{168'600});
    EXPECT_EQ(slots[i].needs, i < 5 ? Duration{232'200} : Duration{168'600});
    EXPECT_EQ(slots[i].can_frames, i < 5 ? 2 : 1);
    EXPECT_EQ(slots[i].has, Duration{84'000});
    EXPECT_FALSE(slots[i].holds(kOne));
    EXPECT_EQ(slots[i].holds(2'500'000), i >= 5);  // 210 us
  }
  EXPECT_EQ(smallest_time_scale(slots), 2'764'286);  // 232.2 / 84 is 2.76428571...
}

TEST(ScheduleOnCan, LengthsAreThoseOfTheMapping) {
  const std::vector<std::pair<int, std::vector<int>>> lengths{
      {0, {8}},   {2, {12}},     {4, {16}},      {5, {20}},      {20, {48}},        {21, {64}},
      {28, {64}}, {29, {64, 8}}, {30, {64, 12}}, {57, {64, 64}}, {58, {64, 64, 5}}, {127, {64, 64, 64, 64, 24}}};
  for (const auto& [words, frames] : lengths) {
    SCOPED_TRACE(words);
    Duration sum{};
    for (const int bytes : frames) sum += longest(bytes, kFast);
    const auto slots = slots_on_can(with_payload(words), kFast);
    ASSERT_EQ(slots.size(), 1u);
    EXPECT_EQ(slots[0].frame, sum);
    EXPECT_EQ(slots[0].needs, sum);
    EXPECT_EQ(slots[0].can_frames, static_cast<int>(frames.size()));
  }
}

TEST(ScheduleOnCan, DrawnFramesLastNoLonger) {
  for (const int words : {0, 3, 8, 28, 29, 64, 127}) {
    const auto slots = slots_on_can(with_payload(words), kFast);
    schedules::model::CanBus bus;
    bus.flexible_data_rate = true;
    bus.nominal_bit_rate = kFast.nominal;
    bus.data_bit_rate = kFast.data;
    for (int cycle = 0; cycle < 64; ++cycle) {
      const Bytes frame = drawn_frame(schedules::model::Channel::kA, 1 + 32 * cycle, cycle, words);
      Duration sum{};
      const auto on_can = frame_to_can(1 + 32 * cycle, frame);
      for (const canfd_frame& can : on_can.all()) sum += wire::can_frame_duration(bus, can.can_id, data_of(can));
      EXPECT_LE(sum, slots[0].frame) << words;
      EXPECT_GT(sum, Duration{slots[0].frame.ns * 3 / 4}) << words;
    }
  }
}

// Only sync frames have follow-ups: a sync node's key slot, sent by that node.
TEST(ScheduleOnCan, OnlySyncFramesAreFollowedUp) {
  Cluster cluster = with_payload(0);
  auto& sender = *cluster.nodes[0].flexray;
  const auto followed_up = [&] { return slots_on_can(cluster, kFast)[0].can_frames == 2; };
  EXPECT_FALSE(followed_up());
  sender.pKeySlotId = 1;
  EXPECT_FALSE(followed_up());
  sender.pKeySlotUsedForSync = true;
  EXPECT_TRUE(followed_up());
  EXPECT_EQ(slots_on_can(cluster, kFast)[0].needs, longest(8, kFast) + longest(12, kFast));
  EXPECT_EQ(slots_on_can(cluster, kFast)[0].frame, longest(8, kFast));
  sender.pKeySlotId = 2;
  cluster.nodes[1].flexray->pKeySlotId = 1;
  cluster.nodes[1].flexray->pKeySlotUsedForSync = true;  // but node 0 sends in slot 1
  EXPECT_FALSE(followed_up());
}

// Each channel of the slot has its own sender, the second one a sync node. One row has the needs of the
// longer one.
TEST(ScheduleOnCan, ASlotOfSeveralFramesIsJudgedByTheLongest) {
  Cluster cluster = with_payload(8);
  cluster.nodes[1].flexray->pKeySlotId = 1;
  cluster.nodes[1].flexray->pKeySlotUsedForSync = true;
  cluster.frames = {{1, Channels::kA, 0, 1, NodeId{0}, kNoPdu, 0, 0}, {1, Channels::kB, 0, 1, NodeId{1}, kNoPdu, 0, 0}};
  for (int order = 0; order < 2; ++order) {
    const auto slots = slots_on_can(cluster, kFast);
    ASSERT_EQ(slots.size(), 1u);
    EXPECT_EQ(slots[0].channels, Channels::kAB);
    EXPECT_EQ(slots[0].can_frames, 2);
    EXPECT_EQ(slots[0].needs, longest(24, kFast) + longest(12, kFast));
    std::ranges::reverse(cluster.frames);
  }
}

// Slots 21..24: fragments of 56 bytes. (9 + 1 + 80 + 560 + 2 + 1) bits of at most 0.10015 us are ten
// minislots of 7 us less 0.15 %. With one more for the beginning and one of idle phase: 84 us.
TEST(ScheduleOnCan, DynamicFramesHaveTheirMinislots) {
  const auto slots = slots_on_can(shipped("flexray_demo"), kFast);
  ASSERT_EQ(slots.size(), 14u);
  for (std::size_t i = 10; i < 14; ++i) {
    EXPECT_EQ(slots[i].slot, static_cast<int>(i) + 11);
    EXPECT_TRUE(slots[i].dynamic);
    EXPECT_EQ(slots[i].needs, longest(64, kFast));
    EXPECT_EQ(slots[i].has, Duration{84'000});
  }
  // Static ones: 32 bytes of payload are a frame of 40, and on CAN FD one of 48; slots of 50 us.
  EXPECT_EQ(slots[6].needs, longest(48, kFast));
  EXPECT_EQ(slots[6].has, Duration{50'000});
  EXPECT_EQ(slots[0].needs, longest(48, kFast) + longest(12, kFast));
  EXPECT_EQ(smallest_time_scale(slots), 4'004'000);  // 200.2 / 50
}

// Fragments of two lengths in one dynamic slot have different room.
TEST(ScheduleOnCan, DynamicFramesOfDifferentLengthsAreJudgedApart) {
  Cluster cluster = with_payload(8);
  cluster.flexray.gNumberOfMinislots = 60;
  cluster.flexray.gdMinislot = 7;
  cluster.pdus.resize(2);
  cluster.pdus[0].fragment_bytes = 8;
  cluster.pdus[1].fragment_bytes = 200;
  cluster.frames.push_back({11, Channels::kA, 0, 2, NodeId{0}, PduId{0}, 0, 0});
  cluster.frames.push_back({11, Channels::kA, 1, 2, NodeId{1}, PduId{1}, 0, 0});
  const auto slots = slots_on_can(cluster, kFast);
  ASSERT_EQ(slots.size(), 3u);
  EXPECT_EQ(slots[1].slot, 11);
  EXPECT_EQ(slots[2].slot, 11);
  EXPECT_LT(slots[1].has, slots[2].has);
  EXPECT_EQ(slots[1].needs, longest(16, kFast));
  EXPECT_EQ(slots[2].needs, longest(64, kFast) * 3 + longest(32, kFast));  // 208 bytes: 3 x 61 and 25
}

TEST(ScheduleOnCan, TheSmallestTimeScaleIsTheSmallest) {
  for (const BitRates rates :
       {kFast, BitRates{500'000, 2'000'000}, BitRates{1'000'000, 8'000'000}, BitRates{10'000, 10'000}})
    for (const int words : {0, 8, 28, 127}) {
      Cluster cluster = with_payload(words);
      cluster.flexray.gdMacrotick_ps = 1'375'001;
      const auto slots = slots_on_can(cluster, rates);
      EXPECT_EQ(slots[0].has, Duration{115'500});  // 84 macroticks: 115500.084 ns
      const std::int64_t smallest = smallest_time_scale(slots);
      EXPECT_TRUE(slots[0].holds(smallest)) << smallest;
      EXPECT_FALSE(slots[0].holds(smallest - 1)) << smallest;
    }
  EXPECT_EQ(smallest_time_scale({}), schedules::check::kSmallestTimeScale);
}

}  // namespace
}  // namespace ttf::bus::socketcan
