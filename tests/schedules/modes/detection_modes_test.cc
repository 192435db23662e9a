// Modes of a detector: instants, rules and chains.
#include "schedules/modes/detection_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "schedules/analysis/chain/chains.h"
#include "schedules/analysis/chain/rest.h"
#include "schedules/sequence/generator.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/durations.h"

namespace ttf::schedules::modes {
namespace {

using testing::HasSubstr;

// The camera's preprocessing stands for a detector of three cameras. Frames are those of table 4.
class DetectionModes : public ::testing::Test {
 protected:
  Mode mode(Duration bound) const {
    return placed(cluster, sequence::generated({3, interest, us(138'900), us(27'700), bound}), times, grid);
  }
  std::vector<std::string> findings(const std::vector<Mode>& modes) const {
    std::vector<std::string> words;
    for (const Finding& one : unsound(cluster, detector(), modes, grid)) words.push_back(one.sentence());
    return words;
  }
  Detector detector() const {
    const NodeId node = *cluster.find_node("camera_pre");
    return {node, &cluster.node(node).tasks[0]};
  }

  std::vector<int> interest{0};
  model::Cluster cluster = file::load_cluster(shipped_path("closed_loop_synchronised"));
  sequence::DetectionTimes times{3, us(46'300), us(27'700)};
  Grid grid;
};

// 46.3 ms take five steps of 10 ms, and 27.7 ms take three.
TEST_F(DetectionModes, DetectionsBeginOnTheGrid) {
  const Mode primaries = mode({}), more = mode(ms(200));
  EXPECT_EQ(primaries.frame, ms(150));
  EXPECT_EQ(more.frame, ms(240));
  EXPECT_EQ(more.cycles, 48);
  std::vector<std::int64_t> cycles;
  for (const PlacedDetection& one : more.detections) cycles.push_back(one.cycle);
  EXPECT_EQ(cycles, (std::vector<std::int64_t>{0, 10, 16, 26, 32, 42}));
  EXPECT_THAT(findings({primaries, more, mode(ms(300))}), testing::IsEmpty());
}

TEST_F(DetectionModes, ADetectionMustEndBeforeItsStepsByAnyClock) {
  times = {3, us(49'990), us(27'700)};
  const auto words = findings({mode(ms(200))});
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("--primary = 49.99 ms: must end"));
}

// Two secondary detections end 30 ms apart.
TEST_F(DetectionModes, ListsMustNotComeFasterThanTheirCanAllows) {
  const auto message = [&]() -> model::CanMessage& {
    for (model::CanBus& bus : cluster.can_buses)
      for (model::CanMessage& one : bus.messages)
        if (cluster.pdu(one.pdu).name == "camera_objects") return one;
    throw 0;
  };
  message().shortest_period = ms(29);
  EXPECT_THAT(findings({mode(ms(300))}), testing::IsEmpty());
  message().shortest_period = ms(30);
  EXPECT_THAT(findings({mode({})}), testing::IsEmpty()) << "primary detections alone";
  const auto words = findings({mode({}), mode(ms(300))});
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("two detections may be 29.9"));
}

// The list goes over FlexRay, in every fourth or eighth cycle.
TEST_F(DetectionModes, ListsMustHaveSlotsBetweenAnyTwoDetections) {
  model::Task& task = cluster.nodes[index_of(*cluster.find_node("odometry_pre"))].tasks[0];
  const Detector there{*cluster.find_node("odometry_pre"), &task};
  const auto with_repetition = [&](int repetition) {
    for (model::FrameSlot& frame : cluster.frames)
      if (frame.pdu == task.writes[0].pdu) frame.repetition = repetition;
    return unsound(cluster, there, {mode(ms(300))}, grid);
  };
  EXPECT_TRUE(with_repetition(4).empty());
  EXPECT_EQ(with_repetition(8).size(), 1u) << "40 ms are too long for detections 30 ms apart";
  grid.best_case = ms(5);
  EXPECT_EQ(with_repetition(4).size(), 1u) << "a list may leave 7.3 ms behind the one before";
  grid.best_case.reset();
  cluster.nodes[index_of(there.node)].tasks.push_back(task);
  EXPECT_THAT(
      unsound(cluster, {there.node, cluster.nodes[index_of(there.node)].tasks.data()}, {mode({})}, grid)[0].sentence(),
      HasSubstr("only task"));
}

// A primary detection of 46.3 ms ends 3.7 ms before the next one begins, which may last 5 ms.
TEST_F(DetectionModes, ListsThatLeaveEarlyAreNearerToEachOther) {
  const auto waiting = bounds(cluster, detector(), mode({}), grid, 0);
  grid.best_case = ms(5);
  EXPECT_EQ(mode({}).detections[1].best_case, ms(5));
  const auto words = findings({mode({})});
  ASSERT_EQ(words.size(), 1u) << "lists may come every 20 ms";
  EXPECT_THAT(words[0], HasSubstr("two detections may be 8.6"));
  const auto early = bounds(cluster, detector(), mode({}), grid, 0);
  EXPECT_LT(early[0].least, waiting[0].least - ms(39));
  EXPECT_EQ(early[0].most, waiting[0].most);
  grid.best_case = ms(60);
  EXPECT_EQ(mode({}).detections[0].best_case, us(46'300)) << "no more than the worst case";
}

// Lists of the camera leave between 1.014 and 1.171 ms of each cycle of 2 ms. They are written 19.8 ms behind the beginning at
// 1.1 ms, and the next one at 21.1 ms.
TEST_F(DetectionModes, AListInTheDynamicSegmentCountsWithItsLatestTurn) {
  cluster = file::load_cluster(shipped_path("flexray_demo"));
  grid.best_case = Duration{};
  const auto begins_at = [&](int offset, Duration lasts) {
    grid.offset = Macroticks{offset};
    const sequence::DetectionTimes short_ones(1, lasts, ms(1));
    return findings({placed(cluster, {sequence::Detection{0, false}}, short_ones, grid)}).size();
  };
  EXPECT_EQ(begins_at(1100, us(19'800)), 1u);
  EXPECT_EQ(begins_at(1200, us(19'700)), 0u) << "the next one is written at 21.2 ms";
  cluster.nodes[index_of(detector().node)].flexray->pLatestTx = 10;
  EXPECT_EQ(begins_at(1200, us(19'700)), 1u) << "its turn may not come";
}

// A detection may begin and end like the preprocessing. Its chain is the same.
TEST_F(DetectionModes, TheRestOfAChainIsThatOfTheWholeOne) {
  const auto rests = analysis::chain::rests_behind(cluster, detector().node, *detector().task);
  ASSERT_EQ(rests.size(), 2u) << "cruise control and emergency braking";
  const auto all = analysis::chain::chains(cluster);
  const auto whole = std::ranges::find(all, rests[0].name(), &analysis::chain::Chain::name);
  ASSERT_NE(whole, all.end());
  // At worst, the preprocessing begins 5.9 ms behind the measurement.
  const model::Sensor& camera = cluster.sensor(whole->sensor);
  const GlobalTime begins = model::time_of(cluster.flexray, 8 * 40 + 1, camera.at.offset) + us(5'900);
  EXPECT_NEAR(in_ms(rests[0].latest(begins, ms(26)) + us(5'900)), in_ms(whole->reduced_reaction_worst()), 0.2);
  EXPECT_LT(rests[0].earliest(begins, ms(26)), rests[0].latest(begins, ms(26)));
}

TEST_F(DetectionModes, BoundsHoldForEveryBeginningAndAcrossChanges) {
  const Mode primaries = mode({}), more = mode(ms(200));
  const auto of_primaries = bounds(cluster, detector(), primaries, grid, 0),
             of_more = bounds(cluster, detector(), more, grid, 0);
  ASSERT_EQ(of_primaries.size(), 3u);
  // The actuator reads every 40 ms, and a frame may begin every 10 ms.
  for (const CameraBound& camera : of_primaries) {
    EXPECT_GT(camera.most - camera.least, ms(25));
    EXPECT_LT(camera.most - camera.least, ms(45));
    EXPECT_EQ(camera.reaction, camera.reaction_in_region);
    EXPECT_NEAR(in_ms(camera.reaction - camera.most), 150.0, 0.1);
  }
  // Camera A has its region every 50 to 80 ms, and whole pictures once in a frame.
  EXPECT_NEAR(in_ms(of_more[0].reaction - of_more[0].most), 240.0, 5.0);
  EXPECT_LT(of_more[0].reaction_in_region, of_primaries[0].reaction);
  EXPECT_GT(of_more[1].reaction, of_primaries[1].reaction);
  EXPECT_LT(of_more[0].least, of_primaries[0].least) << "a secondary detection is shorter";
  // A is first in both modes. B follows 80 ms behind the frame's beginning instead of 50 ms.
  const auto change = bounds_of_change(cluster, detector(), primaries, more, grid, 0);
  const auto back = bounds_of_change(cluster, detector(), more, primaries, grid, 0);
  EXPECT_EQ(change[0].reaction, of_primaries[0].reaction);
  EXPECT_NEAR(in_ms(change[1].reaction - of_primaries[1].reaction), 30.0, 5.0);
  EXPECT_LT(back[0].reaction_in_region, of_primaries[0].reaction);
}

}  // namespace
}  // namespace ttf::schedules::modes
