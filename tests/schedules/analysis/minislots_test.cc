// The dynamic segment worked out by hand, and against its own counter's rule.
#include "schedules/analysis/minislots.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/ages.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/dynamic_load.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/exchange/cluster_text.h"
#include "schedules/timing/response/flexray_dynamic.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::analysis {
namespace {

model::FrameSlot frame(int slot, model::Channels channels, NodeId sender, PduId pdu) {
  return {slot, channels, 0, 1, sender, pdu, 0, 0, false};
}

// 10 static slots of 50; minislots of 7 MT, action point 3, one idle; lists of 8 bytes (4 words), 32 (16) and
// 56 (28).
model::Cluster dynamic() {
  model::Cluster cluster;
  model::GlobalParameters& g = cluster.flexray;
  g.gNumberOfStaticSlots = 10;
  g.gdStaticSlot = 50;
  g.gdActionPointOffset = 4;
  g.gdMinislot = 7;
  g.gNumberOfMinislots = 40;
  g.gdMinislotActionPointOffset = 3;
  g.gdDynamicSlotIdlePhase = 1;
  for (const int bytes : {8, 32, 56}) {
    cluster.pdus.emplace_back().fragment_bytes = bytes;
    cluster.pdus.back().max_elements = cluster.pdus.back().elements_per_fragment = 1;
    cluster.nodes.emplace_back().flexray.emplace().pLatestTx = 20;
  }
  return cluster;
}

// TSS 9 + 1 + 80 + 20 per word + 2 bits, and one of the DTS, 0.10015 us each, in minislots of 7 * 0.9985 us:
//   4 words: 173 bits, 17.326 us, 2.48 -> 3; 16: 413, 41.362, 5.92 -> 6; 28: 653, 65.398, 9.36 -> 10
// One more counts for the part before the action point, and one is idle.
TEST(Minislots, AFrameTakesSoMany) {
  const model::GlobalParameters g = dynamic().flexray;
  EXPECT_EQ(minislots_of(g, 4), 3 + 1 + 1);
  EXPECT_EQ(minislots_of(g, 16), 6 + 1 + 1);
  EXPECT_EQ(minislots_of(g, 28), 10 + 1 + 1);
  EXPECT_EQ(last_start(g, 28), 29);  // 29..40
  // Behind the static segment, one macrotick later for the action points' difference.
  EXPECT_EQ(minislot_start(g, 1), Macroticks{501});
  EXPECT_EQ(minislot_start(g, 41), Macroticks{501 + 40 * 7});
}

TEST(Minislots, ATurnComesLatestWhenAllSlotsBeforeItAreUsed) {
  model::Cluster cluster = dynamic();
  cluster.frames = {
      frame(11, model::Channels::kAB, NodeId{0}, PduId{2}), frame(13, model::Channels::kA, NodeId{1}, PduId{0}),
      frame(13, model::Channels::kB, NodeId{2}, PduId{1}), frame(15, model::Channels::kAB, NodeId{0}, PduId{0}),
      frame(15, model::Channels::kAB, NodeId{1}, PduId{2})};
  EXPECT_EQ(latest_turn(cluster, cluster.frames[0]), 1);
  EXPECT_EQ(latest_turn(cluster, cluster.frames[1]), 1 + 12 + 1);
  EXPECT_EQ(earliest_turn(cluster.flexray, cluster.frames[3]), 5);
  // On B, where slot 13 takes 8: 12 + 1 + 8 + 1.
  EXPECT_EQ(latest_turn(cluster, cluster.frames[3]), 1 + 12 + 1 + 8 + 1);
  EXPECT_FALSE(always_in_time(cluster, cluster.frames[3]));
  cluster.nodes[0].flexray->pLatestTx = 23;
  EXPECT_TRUE(always_in_time(cluster, cluster.frames[3]));
  cluster.nodes[0].flexray.reset();
  EXPECT_FALSE(always_in_time(cluster, cluster.frames[3]));
}

TEST(Minislots, OnlySlotsOfTheSameCyclesCount) {
  model::Cluster cluster = dynamic();
  cluster.frames = {frame(11, model::Channels::kA, NodeId{0}, PduId{2}),
                    frame(11, model::Channels::kA, NodeId{1}, PduId{1}),
                    frame(12, model::Channels::kA, NodeId{2}, PduId{0})};
  cluster.frames[0].repetition = 4;  // cycles 0, 4, ..: 12 minislots
  cluster.frames[1].base_cycle = 1;  // cycles 1, 3, ..: 8
  cluster.frames[1].repetition = 2;
  EXPECT_EQ(latest_turn(cluster, cluster.frames[2]), 1 + 12);  // in every cycle
  cluster.frames[2].base_cycle = 1;
  cluster.frames[2].repetition = 2;
  EXPECT_EQ(latest_turn(cluster, cluster.frames[2]), 1 + 8);
  cluster.frames[2].base_cycle = 2;
  cluster.frames[2].repetition = 4;
  EXPECT_EQ(latest_turn(cluster, cluster.frames[2]), 1 + 1);
}

// The laser's and the camera's lists are in slots 21 to 24, 12 minislots each, behind 1000 macroticks of
// static segment.
TEST(Minislots, AListGoesOutBetweenItsTurns) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("flexray_demo"));
  const auto laser = slot_groups(cluster, *cluster.find_pdu("laser_objects"));
  const auto camera = slot_groups(cluster, *cluster.find_pdu("camera_objects"));
  ASSERT_EQ(laser.size(), 1u);
  ASSERT_EQ(camera.size(), 1u);
  EXPECT_EQ(laser[0].taken_from, Macroticks{1000});
  EXPECT_EQ(laser[0].taken_by, Macroticks{1003});
  EXPECT_EQ(laser[0].complete_by, Macroticks{1000 + 24 * 7});
  EXPECT_EQ(camera[0].taken_from, Macroticks{1000 + 2 * 7});
  EXPECT_EQ(camera[0].taken_by, Macroticks{1000 + 24 * 7 + 3});
  EXPECT_EQ(camera[0].complete_by, Macroticks{1000 + 48 * 7});
  EXPECT_TRUE(camera[0].bounded);
  // Two lists written just before and just after a turn: at most two cycles apart, at least one.
  EXPECT_EQ(shortest_slot_gap(cluster, *cluster.find_pdu("camera_objects"))->gap, Duration::milliseconds(2));
  EXPECT_EQ(shortest_slot_gap(cluster, *cluster.find_pdu("camera_objects"))->spread, Duration::microseconds(46 * 7));
}

// At best one frame: (9 + 1 + 80 + 560 + 2) bits of 0.1 us, less drift and the oscillators' rounding. At
// worst it missed its turn by a nanosecond. Then it is sent in the next cycle, behind all others.
TEST(Minislots, AgesCountTheWaitForATurn) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("flexray_demo"));
  for (const AgePath& path : measurement_ages(cluster)) {
    const bool laser = cluster.sensor(path.sensor).name == "laser";
    const auto part = std::find_if(path.to_use.begin(), path.to_use.end(), [&](const Contribution& c) {
      return c.name.find("_objects waits") != std::string::npos;
    });
    ASSERT_NE(part, path.to_use.end());
    EXPECT_LE(part->best, Duration{65'200});
    EXPECT_GE(part->best, Duration{65'200 - 300});
    const Duration worst = laser ? Duration::microseconds(2000 + 24 * 7) : Duration::microseconds(2000 + 46 * 7);
    EXPECT_EQ(part->worst, worst - Duration{1});
  }
}

TEST(DynamicLoad, IsThatOfTheFullestCycle) {
  model::Cluster cluster = dynamic();
  cluster.frames = {frame(11, model::Channels::kA, NodeId{0}, PduId{2}),
                    frame(11, model::Channels::kA, NodeId{1}, PduId{1}),
                    frame(13, model::Channels::kAB, NodeId{1}, PduId{0})};
  cluster.frames[0].repetition = 2;  // 12 minislots in even cycles, 8 in odd ones
  cluster.frames[1].base_cycle = 1;
  cluster.frames[1].repetition = 2;
  const auto loads = dynamic_load(cluster);
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].minislots, 12 + 1 + 5);
  EXPECT_DOUBLE_EQ(loads[0].share, 18.0 / 40.0);
  EXPECT_EQ(loads[1].minislots, 2 + 5);
  const auto lists = dynamic_lists(cluster);
  ASSERT_EQ(lists.size(), 3u);
  EXPECT_EQ(lists[2].earliest_turn, 3);
  EXPECT_EQ(lists[2].latest_turn, 14);
  EXPECT_TRUE(lists[2].always_in_time);
  cluster.nodes[1].flexray->pLatestTx = 13;
  EXPECT_FALSE(dynamic_lists(cluster)[2].always_in_time);
  cluster.frames.clear();
  EXPECT_EQ(dynamic_load(cluster)[0].minislots, 0);
  EXPECT_EQ(dynamic_text(cluster), "");
}

TEST(DynamicLoad, IsListedAndDrawn) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("flexray_demo"));
  const std::string text = dynamic_text(cluster);
  EXPECT_NE(text.find("80 minislots of 7 macroticks\nwith every slot in use A takes 48 (60.0 %), B takes 48 (60.0 %)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("23-24  AB  camera_pre  camera_objects 0-1"), std::string::npos) << text;
  EXPECT_NE(text.find("12              3-37     2.322 ms\n"), std::string::npos) << text;
  const std::string shown = exchange::show_text(cluster);
  EXPECT_NE(shown.find(text), std::string::npos);
  EXPECT_NE(shown.find("21-22     1000-1168     AB  laser_pre   laser_objects 0-1 (dynamic)"), std::string::npos)
      << shown;
  EXPECT_NE(shown.find("1560-1573     AB              symbol window"), std::string::npos) << shown;
  // 48 of the 80 minislots, then the rest, then two columns that include symbol window.
  EXPECT_NE(shown.find("sDDDDDDDDDDDDDDDDd"), std::string::npos) << shown;
  EXPECT_NE(shown.find("dwwn"), std::string::npos) << shown;
}

// The frames of a channel as theory has them: each is sent in all cycles of its own.
struct TheoryOfChannel {
  std::vector<model::FrameSlot> frames;
  std::vector<timing::response::DynamicResponse> bounds;

  TheoryOfChannel(const model::Cluster& cluster, model::Channel channel) {
    const model::GlobalParameters& g = cluster.flexray;
    const std::int64_t cycle = minislot_start(g, g.gNumberOfMinislots + 1).value + 1;  // macroticks
    std::vector<timing::response::DynamicMessage> messages;
    for (model::FrameSlot one : cluster.frames) {
      if (!is_dynamic(g, one) || !includes(one.channels, channel)) continue;
      one.channels = channel == model::Channel::kA ? model::Channels::kA : model::Channels::kB;
      frames.push_back(one);
      messages.push_back({.slot = one.slot - g.gNumberOfStaticSlots,
                          .base_cycle = one.base_cycle,
                          .repetition = one.repetition,
                          .minislots = minislots_of(g, dynamic_words(cluster, one)),
                          .latest_tx = cluster.node(one.sender).flexray->pLatestTx,
                          .period = one.repetition * cycle,
                          .jitter = 0});
    }
    const timing::response::DynamicSegment segment{.cycle = cycle,
                                                   .minislot = g.gdMinislot,
                                                   .minislots = g.gNumberOfMinislots,
                                                   .decision = timing::response::DynamicSegment::Decision::kAtTurn};
    bounds = timing::response::covering_bounds(segment, messages);
  }
};

// There is a frame in every slot. Theory bounds those that are always in time. It has the same turns.
TEST(DynamicLoad, TurnsOfShippedClustersAreThoseOfTheory) {
  int judged = 0;
  for (const std::string name : {"flexray_demo", "paper_dynamic", "paper_free_flexray"}) {
    const model::Cluster cluster = check::load_checked_cluster(shipped_path(name));
    for (const model::Channel channel : model::kBothChannels) {
      const TheoryOfChannel theory(cluster, channel);
      for (std::size_t i = 0; i < theory.frames.size(); ++i) {
        ASSERT_TRUE(always_in_time(cluster, theory.frames[i]));
        EXPECT_TRUE(theory.bounds[i].response.bounded());
        EXPECT_EQ(theory.bounds[i].lost_cycles, 0);
        EXPECT_EQ(theory.bounds[i].latest_turn, latest_turn(cluster, theory.frames[i])) << name << " " << i;
        ++judged;
      }
    }
  }
  EXPECT_EQ(judged, 2 * (4 + 16 + 16));
}

TEST(DynamicLoad, TurnsOfDrawnClustersAreThoseOfTheory) {
  int in_time = 0, waiting = 0;
  for (std::uint32_t index = 0; index < 500; ++index) {
    RandomStream stream({.seed = 41, .purpose = Purpose::kTest, .index = index});
    model::Cluster cluster = dynamic();
    cluster.frames.clear();
    const int end = 11 + static_cast<int>(stream.integer(2, 6));
    for (int slot = 11; slot < end; ++slot) {
      cluster.frames.push_back(frame(slot, model::Channels::kA, NodeId{0}, static_cast<PduId>(stream.integer(0, 2))));
      cluster.frames.back().repetition = static_cast<int>(1 << stream.integer(0, 2));
      cluster.frames.back().base_cycle = static_cast<int>(stream.integer(0, cluster.frames.back().repetition - 1));
    }
    const TheoryOfChannel theory(cluster, model::Channel::kA);
    for (std::size_t i = 0; i < theory.frames.size(); ++i) {
      const bool always = always_in_time(cluster, theory.frames[i]);
      ++(always ? in_time : waiting);
      ASSERT_EQ(theory.bounds[i].response.bounded(), always) << "set " << index << ", frame " << i;
      if (!always) break;  // behind a frame without a bound, theory has none
      ASSERT_EQ(theory.bounds[i].latest_turn, latest_turn(cluster, theory.frames[i])) << "set " << index;
    }
  }
  EXPECT_GT(in_time, 500);
  EXPECT_GT(waiting, 50);
}

// A list without dependents may wait for another cycle.
TEST(DynamicLoad, SaysWhatMayHaveToWait) {
  model::Cluster cluster = dynamic();
  cluster.frames = {frame(11, model::Channels::kA, NodeId{0}, PduId{2}),
                    frame(12, model::Channels::kA, NodeId{1}, PduId{2}),
                    frame(13, model::Channels::kA, NodeId{1}, PduId{0})};
  EXPECT_NE(dynamic_text(cluster).find("3-25 or later    unbounded\n"), std::string::npos) << dynamic_text(cluster);
  // Theory has no repetition of five.
  cluster.frames[0].repetition = 5;
  EXPECT_NE(dynamic_text(cluster).find("3-25 or later            -\n"), std::string::npos) << dynamic_text(cluster);
}

// A list comes just too late for the turn of its slot: a cycle later all slots before it are used, too.
TEST(DynamicLoad, TheWaitOfAListThatIsAlwaysInTimeByHand) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("flexray_demo"));
  const auto lists = dynamic_lists(cluster);
  ASSERT_EQ(lists.size(), 2u);
  for (const DynamicList& list : lists) {
    const std::int64_t minislots =
        list.latest_turn - (list.last_slot - cluster.flexray.gNumberOfStaticSlots) + list.minislots_each;
    const Duration nominal = cluster.cycle() * list.repetition +
                             Duration{minislots * cluster.flexray.gdMinislot * cluster.flexray.gdMacrotick_ps / 1'000};
    ASSERT_TRUE(list.sent_within);
    EXPECT_EQ(*list.sent_within, nominal + Duration{clock_bounds(cluster).drift_ns(nominal.ns)});
  }
}

// The slots before it are used in one of eight cycles. So a list that finds them used is sent a cycle later.
TEST(DynamicLoad, AListThatMayWaitHasABoundWhereOthersAreSeldomWritten) {
  model::Cluster cluster = dynamic();
  cluster.frames = {frame(11, model::Channels::kA, NodeId{0}, PduId{2}),
                    frame(12, model::Channels::kA, NodeId{0}, PduId{1}),
                    frame(13, model::Channels::kA, NodeId{1}, PduId{0})};
  cluster.nodes[1].flexray->pLatestTx = 13;
  const auto writes = [&](std::size_t node, int repetition, std::vector<PduId> pdus) {
    model::Task& task = cluster.nodes[node].tasks.emplace_back();
    task.activation.kind = model::ActivationKind::kTime;
    task.activation.at.repetition = repetition;
    task.worst_case = task.best_case = Duration::microseconds(100);
    for (const PduId pdu : pdus) task.writes.push_back({"", pdu, model::kFlexRay, 0});
  };
  writes(0, 8, {PduId{2}, PduId{1}});
  EXPECT_FALSE(dynamic_lists(cluster)[2].sent_within) << "nobody says how often it is written";
  writes(1, 4, {PduId{0}});
  const auto lists = dynamic_lists(cluster);
  ASSERT_FALSE(lists[2].always_in_time);
  ASSERT_TRUE(lists[2].sent_within);
  EXPECT_GT(*lists[2].sent_within, cluster.cycle() * 2);
  EXPECT_LT(*lists[2].sent_within, cluster.cycle() * 3);
}

}  // namespace
}  // namespace ttf::schedules::analysis
