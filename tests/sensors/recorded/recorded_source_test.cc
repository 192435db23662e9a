// A mismatch of recording and cluster is reported before the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "schedules/file/loader.h"
#include "sensors/recorded/recorded.h"
#include "tests/support/refusals.h"

namespace ttf::sensors::recorded {
namespace {

using recording::rows::RecordedInput;
using recording::rows::RecordedObservation;
using testing::HasSubstr;

RecordedInput one_row(const std::string& sensor, RecordedObservation::Kind kind) {
  RecordedInput input;
  input.observations.push_back({.sensor = sensor, .time_us_from_start = 0, .kind = kind});
  input.truth.push_back({});
  return input;
}

// The refusal of this recording as the source of the shipped cluster's sensor; empty if it fits.
std::string refusal(const std::string& sensor, const RecordedInput& input) {
  static const schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/laser_radar.yaml");
  const SensorId id = *cluster.find_sensor(sensor);
  const schedules::model::Task& task = cluster.node(cluster.sensor(id).device).tasks.front();
  return support::refusal_of([&] {
    PlayedRows rows;
    for (const RecordedObservation& row : input.observations)
      if (row.sensor == sensor) rows.at.emplace_back(row);
    rows.times.resize(rows.at.size());
    const RecordedSource source(cluster, task, id, std::move(rows), TrueTime{});
  });
}

TEST(RecordedSource, TakesRowsOfItsSensorAndKindOnly) {
  EXPECT_EQ(refusal("laser", one_row("laser", RecordedObservation::Kind::kPosition)), "");
  EXPECT_EQ(refusal("radar", one_row("radar", RecordedObservation::Kind::kRangeBearingRate)), "");
  EXPECT_THAT(refusal("laser", one_row("radar", RecordedObservation::Kind::kRangeBearingRate)),
              HasSubstr("sensors.laser: the recording has no row of this sensor"));
  EXPECT_THAT(refusal("laser", one_row("laser", RecordedObservation::Kind::kRangeBearingRate)),
              HasSubstr("must have the signals of the recording's rows"));
  EXPECT_THAT(refusal("radar", one_row("radar", RecordedObservation::Kind::kPosition)),
              HasSubstr("must have the signals of the recording's rows"));
}

// Rows at 0 and 100 ms of a vehicle at 10 m/s; the recording begins 5 ms into the run.
TEST(RecordedScene, HasNoTruthBeyondTheRecording) {
  RecordedInput input;
  input.truth.push_back({.time_us_from_start = 0, .x = 20.0, .vx = 10.0});
  input.truth.push_back({.time_us_from_start = 100'001, .x = 21.0, .vx = 10.0});
  const TrueTime start{5'000'000};
  const RecordedScene scene(input, start);
  std::vector<sim::world::ObjectState> states(3);
  const auto at = [&](std::int64_t ns) {
    scene.states_at(start + Duration{ns}, states);
    return states.size();
  };
  EXPECT_EQ(at(-1), 0u);
  ASSERT_EQ(at(0), 1u);
  EXPECT_EQ(states[0].x, 20.0);
  ASSERT_EQ(at(50'000'000), 1u);
  EXPECT_NEAR(states[0].x, 20.5, 0.001);
  ASSERT_EQ(at(100'001'000), 1u);
  EXPECT_EQ(states[0].x, 21.0);
  EXPECT_EQ(at(100'001'001), 0u);
  EXPECT_EQ(at(3'600'000'000'000), 0u);
}

}  // namespace
}  // namespace ttf::sensors::recorded
