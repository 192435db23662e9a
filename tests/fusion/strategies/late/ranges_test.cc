// Range, bearing and range rate among the methods for late measurements, which take them linearised.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fusion/strategies/late/pasts.h"
#include "tests/fusion/strategies/late/late_scenes.h"

namespace ttf::fusion::strategies::late {
namespace {

using oosm::Kind;

linear::Gaussian<4> start() {
  linear::Gaussian<4> state;
  state.x << 60.0, 8.0, -12.0, 2.0;
  state.p.diagonal() << 1.0, 1.0, 4.0, 4.0;
  return state;
}

// An observation with its instant.
struct Measured {
  int ms;
  sensors::Observation z;
};
std::vector<Measured> measurements(std::uint32_t drive) {
  RandomStream noise({5, drive, Purpose::kTest, 0, 0});
  std::vector<Measured> all;
  for (int ms = 40; ms <= 200; ms += 40) {
    const double x = 60.0 - 0.012 * ms, y = 8.0 + 0.002 * ms, range = std::hypot(x, y);
    if (ms % 80 == 0)
      all.push_back({ms, radar(range + 0.2 * noise.normal(), std::atan2(y, x) + 0.004 * noise.normal(),
                               (-12.0 * x + 2.0 * y) / range + 0.1 * noise.normal(), 0.2, 0.004, 0.1)});
    else
      all.push_back({ms, position(x + 0.2 * noise.normal(), y + 0.2 * noise.normal(), 0.2)});
  }
  return all;
}

When when(const Measured& m) {
  return {oosm::Stamp(at_ms(m.ms), {SensorId{0}, static_cast<std::uint32_t>(m.ms)}), Duration{}};
}

linear::Gaussian<4> state_after(Kind kind, const std::vector<Measured>& all, const std::vector<std::size_t>& order,
                                bool ranges) {
  const std::unique_ptr<Pasts> pasts = make_pasts(taking_late(kind), 1, ranges);
  pasts->start(0, at_ms(0), start());
  std::vector<bool> taken(all.size());
  for (const std::size_t i : order) {
    // A clone is announced before its list comes late.
    for (std::size_t j = 0; j < i; ++j)
      if (!taken[j]) pasts->announce(0, when(all[j]).stamp);
    EXPECT_TRUE(pasts->at(0, when(all[i])).has_value());
    pasts->take(0, when(all[i]), all[i].z);
    taken[i] = true;
  }
  return std::get<linear::Gaussian<4>>(pasts->newest(0, at_ms(200)));
}

class LateRanges : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(All, LateRanges,
                         testing::Values(Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kBl1,
                                         Kind::kA, Kind::kB, Kind::kC),
                         name_of_kind);

// In order they are the extended Kalman filter.
TEST_P(LateRanges, InOrderAreThoseOfTheEstimator) {
  const std::vector<Measured> all = measurements(0);
  const auto estimator = estimators::make_estimator(taking_late(GetParam()));
  estimators::Estimate estimate = start();
  int last = 0;
  for (const Measured& m : all) {
    estimator->predict(estimate, 1e-3 * (m.ms - last));
    estimator->update(estimate, m.z);
    last = m.ms;
  }
  const linear::Gaussian<4> state = state_after(GetParam(), all, {0, 1, 2, 3, 4}, true),
                            expected = std::get<linear::Gaussian<4>>(estimate);
  EXPECT_LT((state.x - expected.x).norm(), 1e-9);
  EXPECT_LT((state.p - expected.p).norm(), 1e-9);
}

// One late list, one lag: what linearising at another state loses is far below the standard deviations.
//     40 laser   80 radar   120 laser   160 radar   200 laser
//                 arrives after the laser of 120
TEST_P(LateRanges, OneLagLateAreNearlyAsInOrder) {
  for (std::uint32_t drive = 0; drive < 20; ++drive) {
    const std::vector<Measured> all = measurements(drive);
    const linear::Gaussian<4> late = state_after(GetParam(), all, {0, 2, 1, 3, 4}, true),
                              in_order = state_after(GetParam(), all, {0, 1, 2, 3, 4}, true);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(late.x(i), in_order.x(i), 0.1 * std::sqrt(in_order.p(i, i))) << drive << " " << i;
  }
}

// The third component of a position says nothing.
TEST_P(LateRanges, PositionsAmongThemAreAsThoseAmongPositions) {
  std::vector<Measured> all = measurements(0);
  for (Measured& m : all) m.z = position(60.0 - 0.012 * m.ms, 8.0, 0.2);
  const linear::Gaussian<4> among = state_after(GetParam(), all, {0, 2, 1, 3, 4}, true),
                            alone = state_after(GetParam(), all, {0, 2, 1, 3, 4}, false);
  EXPECT_LT((among.x - alone.x).norm(), 1e-9);
  EXPECT_LT((among.p - alone.p).norm(), 1e-9);
}

}  // namespace
}  // namespace ttf::fusion::strategies::late
