// Filters of one object on a third party's recording, with ground truth. A laser (position, sigma 0.15 m) and
// a radar (range 0.3 m, bearing 0.03 rad, range rate 0.3 m/s) see a vehicle in turn, every 50 ms.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "fusion/filters/extended.h"
#include "fusion/filters/unscented.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/support/recordings.h"

namespace ttf::fusion::filters {
namespace {

using sensors::Measurement;
using sensors::Position;
using sensors::RangeBearingRate;

struct Seen {
  bool radar = false;
  double seconds = 0.0;
  linear::Vector<3> z = linear::Vector<3>::Zero();
  linear::Vector<4> truth = linear::Vector<4>::Zero();  // x, y, vx, vy
};

std::vector<Seen> read_drive(const std::string& path) {
  std::ifstream file(path);
  std::vector<Seen> drive;
  std::int64_t first_us = -1;
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    char kind = 0;
    std::int64_t us = 0;
    Seen seen;
    in >> kind;
    seen.radar = kind == 'R';
    for (int i = 0; i < (seen.radar ? 3 : 2); ++i) in >> seen.z(i);
    in >> us;
    for (int i = 0; i < 4; ++i) in >> seen.truth(i);
    if (first_us < 0) first_us = us;
    seen.seconds = static_cast<double>(us - first_us) * 1e-6;
    drive.push_back(seen);
  }
  return drive;
}

// Figures of one filter over a drive. The truth goes into rmse only.
struct Result {
  linear::Vector<4> rmse = linear::Vector<4>::Zero();
  double laser_nis = 0.0, radar_nis = 0.0;  // means
  double log_likelihood = 0.0;              // over all innovations
};

template <class F> Result follow(const F& filter, const motion::Ctrv& model, const std::vector<Seen>& drive) {
  using M = motion::Ctrv;
  const linear::Matrix<2> laser_r = 0.0225 * linear::Matrix<2>::Identity();
  const linear::Matrix<3> radar_r = linear::Vector<3>(0.09, 0.0009, 0.09).asDiagonal();
  Result result;
  linear::Gaussian<5> state;
  int laser = 0, radar = 0;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const Seen& seen = drive[i];
    if (i == 0) {  // laser first: position known, heading and speed as of any road vehicle in town
      state.x << seen.z(0), seen.z(1), 0.0, 0.0, 0.0;
      state.p.diagonal() << 0.0225, 0.0225, 0.25, 25.0, 0.25;
    } else {
      filter.predict(model, state, seen.seconds - drive[i - 1].seconds);
      if (seen.radar) {
        const Innovation<3> innovation =
            filter.update(model, RangeBearingRate{}, sensors::Measurement<3>{seen.z, radar_r}, state);
        result.radar_nis += innovation.nis;
        result.log_likelihood += innovation.log_likelihood();
        ++radar;
      } else {
        const Innovation<2> innovation =
            filter.update(model, Position{}, sensors::Measurement<2>{seen.z.head<2>(), laser_r}, state);
        result.laser_nis += innovation.nis;
        result.log_likelihood += innovation.log_likelihood();
        ++laser;
      }
    }
    const motion::Kinematics k = M::kinematics<motion::kWithVelocity>(state.x);
    linear::Vector<4> estimated;
    estimated << k.position, k.velocity;
    result.rmse += (estimated - seen.truth).cwiseAbs2();
  }
  result.rmse = (result.rmse / static_cast<double>(drive.size())).cwiseSqrt();
  result.laser_nis /= laser;
  result.radar_nis /= radar;
  return result;
}

constexpr double kTurnDensity = 0.01, kAlongDensity = 0.01;  // [rad^2/s^3], [m^2/s^3]: expect_consistent()

class LaserRadar : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = "laser_radar/measurements.txt";
    if (!std::filesystem::exists(support::recording_path(name))) GTEST_SKIP() << support::recording_missing(name);
    drive = read_drive(support::recording_path(name));
    ASSERT_EQ(drive.size(), 500u);
  }
  template <class F> Result judged(const F& filter) const {
    const Result r = follow(filter, motion::Ctrv(kTurnDensity, kAlongDensity), drive);
    std::cout << F::kName << ": RMSE of px py vx vy " << r.rmse.transpose() << ", mean NIS of laser (2) " << r.laser_nis
              << ", of radar (3) " << r.radar_nis << ", log likelihood " << r.log_likelihood << "\n";
    return r;
  }
  std::vector<Seen> drive;
};

// The process noise is chosen without the truth: of the decades of its two densities, those of the likeliest
// innovations. The innovations then have their stated size (means of 249 and 250, 95 % bands).
template <class F> void expect_consistent(const F& filter, const Result& chosen, const std::vector<Seen>& drive) {
  for (const double turn : {0.1, 1.0, 10.0})
    for (const double along : {0.1, 1.0, 10.0})
      EXPECT_LE(follow(filter, motion::Ctrv(kTurnDensity * turn, kAlongDensity * along), drive).log_likelihood,
                chosen.log_likelihood)
          << turn << " " << along;
  EXPECT_GT(chosen.laser_nis, metrics::chi_square_quantile(0.025, 249.0 * 2.0) / 249.0);
  EXPECT_LT(chosen.laser_nis, metrics::chi_square_quantile(0.975, 249.0 * 2.0) / 249.0);
  EXPECT_GT(chosen.radar_nis, metrics::chi_square_quantile(0.025, 250.0 * 3.0) / 250.0);
  EXPECT_LT(chosen.radar_nis, metrics::chi_square_quantile(0.975, 250.0 * 3.0) / 250.0);
}
void expect_within(const linear::Vector<4>& rmse, const linear::Vector<4>& limits) {
  for (int i = 0; i < 4; ++i) EXPECT_LT(rmse(i), limits(i)) << i;
}

// Limits published for good filters on this set (see the recording's own README).
TEST_F(LaserRadar, Extended) {
  const Result result = judged(Extended{});
  expect_within(result.rmse, {0.11, 0.11, 0.52, 0.52});
  expect_consistent(Extended{}, result, drive);
}
TEST_F(LaserRadar, Unscented) {
  const Result result = judged(Unscented{});
  expect_within(result.rmse, {0.09, 0.10, 0.40, 0.30});
  expect_consistent(Unscented{}, result, drive);
}

}  // namespace
}  // namespace ttf::fusion::filters
