// The replay on a third party's recording (docs/use/recordings.md): a laser and a radar see a vehicle in turn,
// with ground truth. Noise is the recording's documented one. The process noise follows from such a vehicle's
// motion, as in scenarios/laser_radar_recorded.yaml. Published RMSE of px, py, vx, vy for a good extended
// filter: 0.11 0.11 0.52 0.52; for an unscented one 0.09 0.10 0.40 0.30.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include "recording/replay/replay.h"
#include "recording/replay/sensor_timing.h"
#include "recording/rows/laser_radar_file.h"
#include "sensors/recorded/recorded.h"
#include "tests/support/recordings.h"

namespace ttf::recording::replay {
namespace {

class TrackRecorded : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = "laser_radar/measurements.txt";
    if (!std::filesystem::exists(support::recording_path(name))) GTEST_SKIP() << support::recording_missing(name);
    input = recording::rows::read_laser_radar(support::recording_path(name));
    SensorSetup usual;
    const sensors::recorded::RecordedNoise documented;
    usual.noise.position = documented.position_m;
    usual.noise.range = documented.range_m;
    usual.noise.bearing = documented.bearing_rad;
    usual.noise.range_rate = documented.range_rate_mps;
    config = parse_replay_config(
        "tracker: {process_noise: 4.0, confirm_hits: 1, confirm_window: 1, "
        "gate_probability: 0.999999}\n",
        "c.yaml", usual);
    const auto rows = recording::rows::observation_rows_of(input, name);
    list_sensors(config, rows, usual, name);
    Findings findings;
    arrivals = recorded_lists_of(rows, config, name, findings);
    findings.throw_if_any();
    for (const recording::rows::RecordedTruth& truth : input.truth)
      truth_at[(input.first_time_us + truth.time_us_from_start) * 1000] = truth;
  }

  struct Error {
    std::array<double, 4> rmse{};
    std::size_t rows = 0;
    recording::rows::TrackRow last;
  };
  Error error_of(fusion::strategies::StrategyKind strategy) {
    Error error;
    const ReplaySetup setup{strategy, config.tracker, sensor_timings(arrivals, config, strategy), false};
    const ReplayAccount account =
        replay(arrivals, setup, [&](GlobalTime known, std::span<const fusion::tracks::TrackView> tracks) {
          ASSERT_EQ(tracks.size(), 1u) << "one vehicle, one track";
          const recording::rows::TrackRow row = track_row_of(tracks[0], known, arrivals.classes);
          const recording::rows::RecordedTruth& truth = truth_at.at(row.time_ns);
          const std::array<double, 4> off{row.x - truth.x, row.y - truth.y, row.vx - truth.vx, row.vy - truth.vy};
          for (std::size_t i = 0; i < 4; ++i) error.rmse[i] += off[i] * off[i];
          ++error.rows;
          error.last = row;
        });
    EXPECT_EQ(account.tracks, 1u);
    for (double& value : error.rmse) value = std::sqrt(value / static_cast<double>(error.rows));
    std::cout << "RMSE of px py vx vy: " << error.rmse[0] << " " << error.rmse[1] << " " << error.rmse[2] << " "
              << error.rmse[3] << " over " << error.rows << " rows\n";
    return error;
  }

  recording::rows::RecordedInput input;
  ReplayConfig config;
  RecordedLists arrivals;
  std::map<std::int64_t, recording::rows::RecordedTruth> truth_at;
};

TEST_F(TrackRecorded, IsWithinThePublishedLimitsOfAnExtendedFilter) {
  const Error error = error_of(fusion::strategies::StrategyKind::kAdva);
  EXPECT_EQ(error.rows, 500u);
  EXPECT_LT(error.rmse[0], 0.11);
  EXPECT_LT(error.rmse[1], 0.11);
  EXPECT_LT(error.rmse[2], 0.52);
  EXPECT_LT(error.rmse[3], 0.52);
}

// The radar's lists are late by up to 90 ms, so that many come after a younger one of the laser. Under every
// strategy, the tracks end as without delays. (Less than the radar's period: BUFF and TT wait for other
// sensors only.)
TEST_F(TrackRecorded, DelaysChangeNothingInTheEnd) {
  const Error in_order = error_of(fusion::strategies::StrategyKind::kAdva);
  SimulatedArrivals simulated;
  simulated.delays = {std::nullopt, SimulatedArrivals::Delay{Duration::milliseconds(20), Duration::milliseconds(90)}};
  simulate(arrivals, simulated);
  for (const auto strategy : fusion::strategies::kAllStrategies) {
    const Error late = error_of(strategy);
    EXPECT_EQ(late.last.time_ns, in_order.last.time_ns);
    EXPECT_EQ(late.last.x, in_order.last.x);
    EXPECT_EQ(late.last.vy, in_order.last.vy);
    EXPECT_EQ(late.last.covariance, in_order.last.covariance);
  }
}

}  // namespace
}  // namespace ttf::recording::replay
