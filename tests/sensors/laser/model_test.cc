#include "sensors/laser/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "sensors/shape.h"

namespace ttf::sensors::laser {
namespace {

ObjectState box(std::uint16_t id, double x, double y, double heading, double length, double width) {
  ObjectState state;
  state.id = ObjectId{id};
  state.x = x;
  state.y = y;
  state.heading = heading;
  state.length = length;
  state.width = width;
  return state;
}

LaserConfig exact_laser() {
  LaserConfig config;
  config.range_sigma_m = config.miss_at_100m = 0.0;
  config.layers = 1;
  return config;
}

struct Scan {
  std::vector<HitPoint> hits;
  std::vector<ObjectId> truth;
};
Scan scan(const LaserConfig& config, const std::vector<ObjectState>& objects, std::uint32_t sequence = 0,
          std::uint32_t replication = 0, std::uint16_t sensor = 0) {
  Scan s;
  measure_laser(config, objects, {1, replication, sensor, sequence}, s.hits, s.truth);
  return s;
}

// Independent oracle: the ray against each of the four edges, by Cramer's rule.
double ray_against_edges(const ObjectState& object, double azimuth) {
  double nearest = std::numeric_limits<double>::infinity();
  const double dx = std::cos(azimuth), dy = std::sin(azimuth);
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double l = object.length / 2, w = object.width / 2;
  const double u[] = {l, -l, -l, l}, v[] = {w, w, -w, -w};
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    const double ax = object.x + c * u[k] - s * v[k], ay = object.y + s * u[k] + c * v[k];
    const double ex = object.x + c * u[n] - s * v[n] - ax, ey = object.y + s * u[n] + c * v[n] - ay;
    const double determinant = dy * ex - dx * ey;
    if (std::abs(determinant) < 1e-12) continue;
    const double range = (ay * ex - ax * ey) / determinant, along = (dx * ay - dy * ax) / determinant;
    if (range > 0 && along >= 0 && along <= 1) nearest = std::min(nearest, range);
  }
  return nearest;
}

TEST(Laser, ACarStraightAheadIsSeenAsItsRear) {
  const auto [hits, truth] = scan(exact_laser(), {box(0, 20.0, 0.0, 0.0, 4.0, 2.0)});
  ASSERT_FALSE(hits.empty());
  for (const HitPoint& hit : hits) {
    EXPECT_NEAR(hit.range * std::cos(hit.azimuth), 18.0, 1e-9);
    EXPECT_LE(std::abs(hit.range * std::sin(hit.azimuth)), 1.0 + 1e-9);
  }
  // Every beam within +-atan(1 / 18) and no other.
  EXPECT_EQ(hits.size(), 2U * static_cast<std::size_t>(std::atan(1.0 / 18.0) / exact_laser().azimuth_step_rad) + 1U);
}

TEST(Laser, RaysHitOutlinesWhereTheirEdgesAre) {
  const LaserConfig config = exact_laser();
  for (int aspect = 0; aspect < 36; ++aspect)
    for (const double y : {-12.0, 0.0, 7.0}) {
      const ObjectState object = box(0, 25.0, y, 0.175 * aspect, 4.4, 1.8);
      const auto [hits, truth] = scan(config, {object});
      std::size_t expected = 0;
      const auto half = static_cast<int>(config.half_field_rad / config.azimuth_step_rad);
      for (int beam = -half; beam <= half; ++beam)
        expected += std::isfinite(ray_against_edges(object, beam * config.azimuth_step_rad));
      EXPECT_EQ(hits.size(), expected);
      for (const HitPoint& hit : hits) EXPECT_NEAR(hit.range, ray_against_edges(object, hit.azimuth), 1e-9);
    }
}

// In any position: also around the sensor, beside it, behind it, and cut by the end of the field.
TEST(Laser, EveryBeamEndsAtTheNearestOutline) {
  const LaserConfig config = exact_laser();
  const auto half = static_cast<int>(config.half_field_rad / config.azimuth_step_rad);
  RandomStream place({5, 0, Purpose::kTest, 2, 0});
  std::size_t seen = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<ObjectState> objects;
    for (std::uint16_t id = 0; id < 4; ++id) {
      const double range = 60.0 * place.uniform() * place.uniform(), bearing = 7.0 * place.uniform();
      objects.push_back(box(id, range * std::cos(bearing), range * std::sin(bearing), 7.0 * place.uniform(),
                            0.1 + 12.0 * place.uniform(), 0.1 + 3.0 * place.uniform()));
    }
    const auto [hits, truth] = scan(config, objects);
    std::size_t next = 0;
    for (int beam = -half; beam <= half; ++beam) {
      double nearest = config.max_range_m;
      for (const ObjectState& object : objects) {
        const auto range = RayTarget(object).ray_to(beam * config.azimuth_step_rad);
        if (range) nearest = std::min(nearest, *range);
      }
      if (nearest == config.max_range_m) continue;
      ASSERT_LT(next, hits.size()) << "trial " << trial << " beam " << beam;
      ASSERT_EQ(hits[next].azimuth, beam * config.azimuth_step_rad);
      ASSERT_EQ(hits[next].range, nearest);
      ++next;
    }
    EXPECT_EQ(next, hits.size());
    seen += next;
  }
  EXPECT_GT(seen, 5000u);
}

// A scan's beams are shifted together, evenly by up to half a step. A beam keeps its draws.
TEST(Laser, APhaseShiftsAllBeamsOfAScan) {
  LaserConfig config = exact_laser();
  config.azimuth_phase = AzimuthPhase::kDrawn;
  const std::vector<ObjectState> car{box(0, 20.0, 0.3, 0.0, 4.0, 2.0)};
  constexpr int kScans = 4000;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t sequence = 0; sequence < kScans; ++sequence) {
    const auto [hits, truth] = scan(config, car, sequence);
    ASSERT_GT(hits.size(), 20u);
    const auto phase_of = [&](const HitPoint& hit) {
      return std::remainder(hit.azimuth / config.azimuth_step_rad, 1.0);
    };
    const double phase = phase_of(hits.front());
    for (const HitPoint& hit : hits) {
      ASSERT_NEAR(std::remainder(phase_of(hit) - phase, 1.0), 0.0, 1e-9);
      ASSERT_NEAR(hit.range, ray_against_edges(car.front(), hit.azimuth), 1e-9);
    }
    sum += phase;
    squares += phase * phase;
  }
  EXPECT_NEAR(sum / kScans, 0.0, 0.02);
  EXPECT_NEAR(squares / kScans, 1.0 / 12.0, 0.005);

  LaserConfig noisy = config;
  noisy.range_sigma_m = 0.06;
  LaserConfig fixed = noisy;
  fixed.azimuth_phase = AzimuthPhase::kFixed;
  const std::vector<ObjectState> wall{box(0, 20.0, 0.0, 0.0, 4.0, 100.0)};
  const Scan drawn = scan(noisy, wall), still = scan(fixed, wall);
  ASSERT_EQ(drawn.hits.size(), still.hits.size());
  for (std::size_t i = 0; i < drawn.hits.size(); ++i) {
    const double noise = drawn.hits[i].range - ray_against_edges(wall.front(), drawn.hits[i].azimuth);
    EXPECT_NEAR(noise, still.hits[i].range - ray_against_edges(wall.front(), still.hits[i].azimuth), 1e-9);
  }
}

TEST(Laser, NearObjectsHideFarOnes) {
  // Behind: fully hidden. Beside: its left half shows.
  const auto [hits, truth] = scan(exact_laser(), {box(0, 40.0, 0.0, 0.0, 4.0, 1.8), box(1, 12.0, 0.0, 0.0, 4.0, 2.0),
                                                  box(2, 40.0, 4.0, 0.0, 4.0, 1.8)});
  EXPECT_EQ(std::count(truth.begin(), truth.end(), ObjectId{0}), 0);
  EXPECT_GT(std::count(truth.begin(), truth.end(), ObjectId{1}), 10);
  EXPECT_GT(std::count(truth.begin(), truth.end(), ObjectId{2}), 0);
  const double edge = std::atan2(1.0, 10.0);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (truth[i] == ObjectId{2}) {
      EXPECT_GT(hits[i].azimuth, std::atan2(1.0, 14.0)) << "seen through";
    } else {
      EXPECT_LE(std::abs(hits[i].azimuth), edge + 1e-9);
    }
  }
}

TEST(Laser, HalfHiddenObjectsShowTheOtherHalf) {
  // The near one's left edge is seen under atan(1/10) = 0.0997 rad. The far one spans y = 2.1..3.9 at 28 m:
  // 0.075..0.138.
  const auto [hits, truth] = scan(exact_laser(), {box(0, 12.0, 0.0, 0.0, 4.0, 2.0), box(1, 30.0, 3.0, 0.0, 4.0, 1.8)});
  double low = 1.0, high = -1.0;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (truth[i] == ObjectId{1}) {
      low = std::min(low, hits[i].azimuth);
      high = std::max(high, hits[i].azimuth);
    }
  EXPECT_GT(low, std::atan(0.1));
  EXPECT_LT(low, std::atan(0.1) + exact_laser().azimuth_step_rad);
  EXPECT_NEAR(high, std::atan2(3.9, 28.0), exact_laser().azimuth_step_rad);
}

TEST(Laser, NothingBehindOrOutsideTheFieldOrBeyondTheRange) {
  EXPECT_TRUE(scan(exact_laser(), {box(0, -20.0, 0.0, 0.0, 4.0, 2.0)}).hits.empty());
  EXPECT_TRUE(scan(exact_laser(), {box(0, 5.0, 30.0, 0.0, 4.0, 2.0)}).hits.empty());
  EXPECT_TRUE(scan(exact_laser(), {box(0, 130.0, 0.0, 0.0, 4.0, 2.0)}).hits.empty());
}

TEST(Laser, RangeNoiseHasItsMeanAndSigma) {
  LaserConfig config;
  config.miss_at_100m = 0.0;
  const std::vector<ObjectState> car = {box(0, 30.0, 0.0, 0.0, 4.0, 2.0)};
  double sum = 0, squared = 0;
  int n = 0;
  for (std::uint32_t sequence = 0; sequence < 100; ++sequence)
    for (const HitPoint& hit : scan(config, car, sequence).hits) {
      const double error = hit.range - 28.0 / std::cos(hit.azimuth);
      sum += error;
      squared += error * error;
      ++n;
    }
  ASSERT_GT(n, 4000);
  EXPECT_NEAR(sum / n, 0.0, 4.0 * config.range_sigma_m / std::sqrt(n));
  EXPECT_NEAR(squared / n / (config.range_sigma_m * config.range_sigma_m), 1.0, 4.0 * std::sqrt(2.0 / n));
}

TEST(Laser, LossesGrowWithTheRangeSquared) {
  const LaserConfig config;
  for (const double range : {25.0, 50.0, 100.0}) {
    // A wide wall gives many hits; only beams near the axis, where the range is the distance.
    const std::vector<ObjectState> wall = {box(0, range + 0.5, 0.0, 0.0, 1.0, 0.2 * range)};
    const std::size_t all = scan(exact_laser(), wall).hits.size() * 4;
    std::size_t seen = 0;
    for (std::uint32_t sequence = 0; sequence < 60; ++sequence) seen += scan(config, wall, sequence).hits.size();
    const double expected = config.miss_at_100m * range * range / 1e4;
    const double n = 60.0 * static_cast<double>(all);
    // The wall's ends are 0.5 % further than its middle: 1 % more loss.
    EXPECT_NEAR(1.0 - static_cast<double>(seen) / n, expected, 4.0 * std::sqrt(expected / n) + 0.01 * expected)
        << range;
  }
}

TEST(Laser, BiasesAreConstant) {
  LaserConfig config = exact_laser();
  const std::vector<ObjectState> car = {box(0, 30.0, 0.0, 0.3, 4.0, 2.0)};
  const Scan plain = scan(config, car);
  config.range_bias.fixed = 0.25;
  config.azimuth_bias.fixed = -0.01;
  const Scan biased = scan(config, car, 5);
  ASSERT_EQ(plain.hits.size(), biased.hits.size());
  for (std::size_t i = 0; i < plain.hits.size(); ++i) {
    EXPECT_NEAR(biased.hits[i].range - plain.hits[i].range, 0.25, 1e-12);
    EXPECT_NEAR(biased.hits[i].azimuth - plain.hits[i].azimuth, -0.01, 1e-12);
  }
}

TEST(Laser, AListIsNeverLongerThanItsMessage) {
  const LaserConfig config;
  const Scan s = scan(config, {box(0, 12.0, 0.0, 0.0, 4.0, 40.0)});
  EXPECT_EQ(s.hits.size(), 1300U);
  EXPECT_EQ(s.truth.size(), 1300U);
  for (std::size_t i = 1; i < s.hits.size(); ++i) {
    EXPECT_LE(s.hits[i - 1].azimuth, s.hits[i].azimuth);
    if (s.hits[i - 1].azimuth == s.hits[i].azimuth) {
      EXPECT_LT(s.hits[i - 1].layer, s.hits[i].layer);
    }
  }
}

TEST(Laser, DrawsBelongToSensorSequenceAndReplication) {
  const LaserConfig config;
  const std::vector<ObjectState> car = {box(0, 30.0, 0.0, 0.3, 4.0, 2.0)};
  const auto ranges = [&](std::uint32_t sequence, std::uint32_t replication, std::uint16_t sensor) {
    std::vector<double> r;
    for (const HitPoint& hit : scan(config, car, sequence, replication, sensor).hits) r.push_back(hit.range);
    return r;
  };
  const auto seventh = ranges(7, 0, 0);
  EXPECT_NE(ranges(8, 0, 0), seventh);
  EXPECT_NE(ranges(7, 1, 0), seventh);
  EXPECT_NE(ranges(7, 0, 1), seventh);
  EXPECT_EQ(ranges(7, 0, 0), seventh) << "not a function of the measurement's number alone";
}

// Neither the scan's other hits nor their beginnings shift a beam's noise.
TEST(Laser, DrawsBelongToTheBeam) {
  const LaserConfig config;
  const ObjectState far = box(0, 40.0, 6.0, 0.0, 4.4, 1.8), right = box(1, 15.0, -5.0, 0.0, 4.4, 1.8);
  const Scan alone = scan(config, {far}, 3), both = scan(config, {far, right}, 3);
  std::size_t i = 0;
  for (std::size_t k = 0; k < both.hits.size(); ++k) {
    if (both.truth[k] != ObjectId{0}) continue;
    ASSERT_LT(i, alone.hits.size());
    EXPECT_EQ(both.hits[k].azimuth, alone.hits[i].azimuth);
    EXPECT_EQ(both.hits[k].range, alone.hits[i].range);
    ++i;
  }
  EXPECT_EQ(i, alone.hits.size());
  EXPECT_GT(both.hits.size(), alone.hits.size() + 20);
}

// The beams' parts of the stream do not overlap: neighbours' noise is neither equal nor shifted by a layer.
TEST(Laser, BeamsDrawIndependently) {
  LaserConfig config;
  config.miss_at_100m = 0.0;
  const Scan s = scan(config, {box(0, 15.0, 0.0, 0.0, 1.0, 20.0)});
  std::vector<double> noise;
  for (const HitPoint& hit : s.hits) noise.push_back(hit.range - 14.5 / std::cos(hit.azimuth));
  ASSERT_GT(noise.size(), 400u);
  for (std::size_t a = 0; a < noise.size(); ++a)
    for (std::size_t b = a + 1; b < std::min(noise.size(), a + 12); ++b) ASSERT_NE(noise[a], noise[b]);
}

}  // namespace
}  // namespace ttf::sensors::laser
