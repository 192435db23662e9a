#include "recording/replay/recorded_ego.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "recording/replay/replay.h"
#include "recording/replay/sensor_timing.h"
#include "tests/fusion/ego/vehicle.h"
#include "tests/recording/replay/replay_rows.h"
#include "tests/support/refusals.h"

namespace ttf::recording::replay {
namespace {

using fusion::linear::Vector;
using recording::rows::EgoRows, recording::rows::ObservationRow, recording::rows::parse_ego_rows;

const fusion::ego::Vehicle& vehicle() {
  static const fusion::ego::Vehicle kVehicle(6.0);
  return kVehicle;
}

// The vehicle's motion every 10 ms.
EgoRows motion(bool poses) {
  EgoRows ego{.poses = poses, .rows = {}};
  for (std::int64_t ms = 0; ms <= 5500; ms += 10) {
    const fusion::sensors::Mounting at = vehicle().at(fusion::ego::seconds_of(ms));
    const fusion::ego::OdometrySample sample = fusion::ego::exact_sample(ms);
    ego.rows.push_back({.line = 0, .time_ns = ms * 1'000'000, .value = {sample.speed, sample.yaw_rate}});
    if (poses) ego.rows.back().value = {at.position.x(), at.position.y(), at.yaw};
  }
  return ego;
}

// The camera's rows of two cars, over ground and as they are seen from the vehicle. Both have their truth.
std::vector<ObservationRow> rows_of(bool from_vehicle) {
  std::vector<ObservationRow> rows;
  for (ObservationRow row : two_cars(5)) {
    if (row.sensor != "camera") continue;
    const double t = 1e-9 * static_cast<double>(row.time_ns);
    row.truth = {row.z[0] < 10.0 + 8.0 * t + 15.0 ? "near" : "far", row.z[0], row.z[1], {{8.0, 0.0}}};
    if (from_vehicle) {
      const Vector<2> seen = vehicle().seen({row.z[0], row.z[1]}, t);
      row.z = {seen.x(), seen.y(), 0.0};
      const Vector<2> velocity = fusion::sensors::turned({8.0, 0.0}, -vehicle().at(t).yaw);
      row.truth->x = seen.x();
      row.truth->y = seen.y();
      row.truth->velocity = {velocity.x(), velocity.y()};
    }
    rows.push_back(row);
  }
  return rows;
}

ReplayConfig exact_config() {
  return parse_replay_config("tracker: {odometry: {speed_sigma: 0, yaw_rate_sigma: 0}}\n", "c.yaml", {});
}

// The last tracks, in the frame in which they live.
std::map<TrackId, fusion::tracks::TrackView> last_of(const RecordedLists& lists, const ReplayConfig& config) {
  std::map<TrackId, fusion::tracks::TrackView> last;
  const ReplaySetup setup{config.strategy, config.tracker, sensor_timings(lists, config, config.strategy), false};
  replay(lists, setup, [&](GlobalTime, std::span<const fusion::tracks::TrackView> views) {
    for (const fusion::tracks::TrackView& view : views) last[view.id] = view;
  });
  return last;
}

// From a vehicle that turns at 30 km/h, the tracks are those of a sensor that stands, and so is the truth; late lists, too.
TEST(RecordedEgo, TracksLiveOverGround) {
  ReplayConfig plain;
  const auto expected = last_of(recorded_lists_of_rows(rows_of(false), plain), plain);
  ASSERT_EQ(expected.size(), 2u);
  for (const bool poses : {true, false})
    for (const bool late : {false, true}) {
      ReplayConfig config = poses ? ReplayConfig{} : exact_config();
      std::vector<ObservationRow> rows = rows_of(true);
      RecordedLists lists = recorded_lists_of_rows(rows, config);
      const RecordedEgo ego = recorded_ego_of(motion(poses), "ego.csv", config);
      carry(lists, rows, ego, "o.csv");
      SimulatedArrivals simulated;
      if (late) simulated.delays.assign(1, SimulatedArrivals::Delay{Duration{}, Duration::milliseconds(150)});
      simulate(lists, simulated);
      const auto last = last_of(lists, config);
      ASSERT_EQ(last.size(), 2u);
      for (const auto& [id, view] : expected) {
        ASSERT_TRUE(last.contains(id));
        EXPECT_LT((last.at(id).state - view.state).norm(), 1e-6) << "poses " << poses << ", late " << late;
        EXPECT_LT((last.at(id).covariance - view.covariance).norm(), 1e-6);
      }
      const std::vector<ObservationRow> over_ground = rows_of(false);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_NEAR(rows[i].truth->x, over_ground[i].truth->x, 1e-6);
        EXPECT_NEAR((*rows[i].truth->velocity)[0], 8.0, 1e-9);
      }
    }
}

TEST(RecordedEgo, EveryRowIsWithinTheMotion) {
  ReplayConfig config;
  std::vector<ObservationRow> rows{position_row("a", 6000, 6000, 1.0, 2.0), position_row("a", 7000, 7000, 1.0, 2.0)};
  rows[0].line = 7;
  rows[1].line = 8;
  RecordedLists lists = recorded_lists_of_rows(rows, config);
  const RecordedEgo ego = recorded_ego_of(motion(true), "ego.csv", config);
  try {
    carry(lists, rows, ego, "o.csv");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 2u);
    EXPECT_EQ(error.findings()[1].sentence(),
              "o.csv:8: time = 7: must be in 0..5.5 s: the vehicle's motion is known there");
  }
}

TEST(RecordedEgo, ContradictionsAreRefused) {
  ReplayConfig across = parse_replay_config("tracker: {cross_noise: 0.1}\n", "c.yaml", {}), both = exact_config();
  const auto sentence = [](ReplayConfig& config, bool poses) -> std::string {
    return support::refusal_of([&] { recorded_ego_of(motion(poses), "ego.csv", config); }, "taken");
  };
  EXPECT_EQ(
      sentence(across, false),
      "c.yaml:1: tracker.cross_noise = 0.1: must be absent with the odometry of ego.csv: the vehicle's axes turn");
  EXPECT_EQ(sentence(both, true), "c.yaml:1: tracker.odometry: must be absent: ego.csv has poses");
}

TEST(EgoRows, AreReadInAnyOrder) {
  const EgoRows poses = parse_ego_rows("heading,time,y,x\n0.5,2,3,4\n0.25,1,5,6\n", "e.csv");
  EXPECT_TRUE(poses.poses);
  ASSERT_EQ(poses.rows.size(), 2u);
  EXPECT_EQ(poses.rows[0].time_ns, 1'000'000'000);
  EXPECT_EQ(poses.rows[0].value, (std::array{6.0, 5.0, 0.25}));
  EXPECT_FALSE(parse_ego_rows("time,speed,yaw_rate\n0,8,0.1\n", "e.csv").poses);
}

std::string mistake(const std::string& text) {
  return support::refusal_of([&] { parse_ego_rows(text, "e.csv"); }, {});
}
TEST(EgoRows, MistakesAreReported) {
  EXPECT_EQ(mistake("time,x,y\n1,2,3\n"),
            "e.csv:1: heading: must be time, x, y, heading or time, speed, yaw_rate, in any order");
  EXPECT_EQ(mistake("time,speed,yaw_rate\n0,8,fast\n"), "e.csv:2: yaw_rate = fast: must be a number in -20..20 rad/s");
  EXPECT_EQ(mistake("time,speed,yaw_rate\n0,8,0\n0,9,0\n"), "e.csv:3: time: must not be that of line 2, too");
  EXPECT_EQ(mistake("time,speed,yaw_rate\n"), "e.csv: holds no row below its heading");
  EXPECT_EQ(mistake("time,speed,yaw_rate\n0,8\n"), "e.csv:2: columns = 2: must be 3, as in the heading");
}

}  // namespace
}  // namespace ttf::recording::replay
