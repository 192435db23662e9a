// The tracker on a third party's recording, with ground truth. A laser (position) and a radar (range,
// bearing, range rate) see a vehicle in turn. Parameters are the documented noise; see the recording's
// README.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "fusion/strategies/strategy.h"
#include "tests/fusion/scenes.h"
#include "tests/support/recordings.h"

namespace ttf::fusion::strategies {
namespace {

struct Row {
  OwnedList list;
  Eigen::Vector4d truth;
};

std::vector<Row> read_rows(const std::string& path) {
  std::ifstream file(path);
  std::vector<Row> rows;
  std::uint32_t sequence[2] = {};
  std::int64_t first_us = -1;
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    char kind = 0;
    double a = 0.0, b = 0.0, c = 0.0;
    std::int64_t us = 0;
    Row row;
    in >> kind >> a >> b;
    if (kind == 'R') in >> c;
    in >> us >> row.truth(0) >> row.truth(1) >> row.truth(2) >> row.truth(3);
    if (first_us < 0) first_us = us;
    const std::uint8_t sensor = kind == 'R' ? 1 : 0;
    row.list = list_of(sensor, sequence[sensor]++, GlobalTime{(us - first_us) * 1000},
                       {kind == 'R' ? radar(a, b, c, 0.3, 0.03, 0.3) : position(a, b, 0.15)});
    rows.push_back(row);
  }
  return rows;
}

// A motion model's parameters, and the limits of its error [m, m/s].
struct Reported {
  const char* name;
  config::MotionModel motion;
  config::FilterKind filter;
  double process_noise;
  linear::Vector<4> limits;
};

// Published limits for a good extended and a good unscented filter on this set, over the whole run.
const linear::Vector<4> kExtendedLimits{0.11, 0.11, 0.52, 0.52}, kUnscentedLimits{0.09, 0.10, 0.40, 0.30};

// 5 m/s and up to 0.55 rad/s: accelerations of 2.8 m/s^2, reached within seconds, last for seconds. On bends
// the densities give the likeliest innovations (tests/fusion/filters/laser_radar_test.cc). One of
// the interacting models drives straight on.
const Reported kReported[] = {
    {"ConstantVelocity", config::MotionModel::kConstantVelocity, config::FilterKind::kExtended, 4.0, kExtendedLimits},
    {"ConstantAcceleration", config::MotionModel::kConstantAcceleration, config::FilterKind::kExtended, 2.0,
     kExtendedLimits},
    {"CtrvExtended", config::MotionModel::kCtrv, config::FilterKind::kExtended, 0.01, kExtendedLimits},
    {"CtrvUnscented", config::MotionModel::kCtrv, config::FilterKind::kUnscented, 0.01, kUnscentedLimits},
    {"CtraExtended", config::MotionModel::kCtra, config::FilterKind::kExtended, 0.01, kExtendedLimits},
    {"CtraUnscented", config::MotionModel::kCtra, config::FilterKind::kUnscented, 0.01, kUnscentedLimits},
    {"Interacting", config::MotionModel::kInteracting, config::FilterKind::kUnscented, 0.01, kUnscentedLimits}};

config::TrackerConfig config_for(const Reported& reported) {
  config::TrackerConfig config = config_of(reported.motion, reported.process_noise, reported.filter);
  config.turn_noise = 0.01;
  config.confirm_hits = 1;
  config.confirm_window = 1;
  config.gate_probability = 0.999999;  // one object, no clutter: gating is unnecessary
  return config;
}

class Recorded : public testing::TestWithParam<Reported> {
 protected:
  void SetUp() override {
    const std::string name = "laser_radar/measurements.txt";
    if (!std::filesystem::exists(support::recording_path(name))) GTEST_SKIP() << support::recording_missing(name);
    rows = read_rows(support::recording_path(name));
    ASSERT_EQ(rows.size(), 500u);
  }
  std::vector<Row> rows;
  const std::vector<SensorTiming> sensors{{SensorId{0}, Settling::after(Duration::milliseconds(10)), false, {}, {}},
                                          {SensorId{1}, Settling::after(Duration::milliseconds(70)), false, {}, {}}};
};
INSTANTIATE_TEST_SUITE_P(Models, Recorded, testing::ValuesIn(kReported),
                         [](const auto& model) { return std::string(model.param.name); });

TEST_P(Recorded, FollowsTheVehicle) {
  const auto strategy = make_strategy(StrategyKind::kAdva, config_for(GetParam()), sensors);
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  std::vector<tracks::TrackView> image;
  for (const Row& row : rows) {
    strategy->accept(row.list.view());
    strategy->fuse(row.list.measured);
    strategy->image(row.list.measured, image);
    ASSERT_EQ(image.size(), 1u) << "one vehicle, one track, at " << row.list.measured.ns << " ns";
    squares += (image[0].state.head<4>() - row.truth).cwiseAbs2();
  }
  const Eigen::Vector4d rmse = (squares / static_cast<double>(rows.size())).cwiseSqrt();
  std::cout << "RMSE of px py vx vy: " << rmse.transpose() << "\n";
  for (int i = 0; i < 4; ++i) EXPECT_LT(rmse(i), GetParam().limits(i)) << i;
}

// The radar's lists come 70 ms late, each after the laser's next. All of them are out of sequence, but not
// lost. The track has the bits of arrival in order.
TEST_P(Recorded, LateRadarEndsWithTheSameBits) {
  const auto in_order = make_strategy(StrategyKind::kAdva, config_for(GetParam()), sensors);
  const auto strategy = make_strategy(StrategyKind::kAdva, config_for(GetParam()), sensors);
  for (const Row& row : rows) {
    in_order->accept(row.list.view());
    in_order->fuse(row.list.measured);
  }
  std::vector<std::pair<GlobalTime, const OwnedList*>> arrivals;
  for (const Row& row : rows)
    arrivals.push_back(
        {row.list.measured + Duration::milliseconds(row.list.id.sensor == SensorId{1} ? 70 : 10), &row.list});
  std::sort(arrivals.begin(), arrivals.end());
  int late = 0;
  for (const auto& [when, arrived] : arrivals) {
    strategy->accept(arrived->view());
    strategy->fuse(when);
    late += strategy->last_fused()[0].disposition == Disposition::kFusedLate;
  }
  EXPECT_EQ(late, 249) << "all 250 radar lists but the last, after which no laser comes";
  std::vector<tracks::TrackView> a, b;
  in_order->image(at_ms(25'500), a);
  strategy->image(at_ms(25'500), b);
  ASSERT_EQ(a.size(), 1u);
  EXPECT_TRUE(same_bits(a, b));
}

}  // namespace
}  // namespace ttf::fusion::strategies
