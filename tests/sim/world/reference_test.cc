#include "sim/world/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/sim/world/drives.h"

namespace ttf::sim::world {
namespace {

// A parked car, the second of two, far enough off for the alignment to show.
WorldConfig parked() {
  WorldConfig config = world_from("objects: [{name: other, x: 10, y: 0}, {name: car, x: 80, y: 60, reference: true}]");
  config.duration = Duration::milliseconds(1000);
  return config;
}

TEST(Reference, FixesArePeriodicAndLate) {
  const WorldConfig config = parked();
  const World world(config, 1, 0);
  const ReferenceConfig defaults;
  const Reference reference(defaults, config, 1, 0);
  for (std::uint32_t k = 0; k < 50; ++k) {
    const Fix fix = reference.fix(k, world);
    EXPECT_EQ(fix.measured, TrueTime{} + defaults.period * k);
    EXPECT_EQ(fix.available - fix.measured, defaults.latency);
    EXPECT_EQ(fix.object, ObjectId{1});
  }
}

TEST(Reference, AlignmentErrorIsConstantOverTheDrive) {
  // Small noise on a short baseline: 14 mrad of alignment error turn 100 m by 1.4 m, against 1 cm of noise.
  ReferenceConfig c;
  c.sigma_m = 0.01;
  c.alignment_baseline_m = 1.0;
  c.excursion_probability = 0.0;
  const WorldConfig config = parked();
  const World world(config, 1, 0);
  std::set<double> errors;
  for (std::uint32_t r = 0; r < 10; ++r) {
    const Reference reference(c, config, 1, r);
    errors.insert(reference.alignment_error_rad());
    for (std::uint32_t k = 0; k < 100; ++k) {
      const Fix fix = reference.fix(k, world);
      const double turned = std::atan2(fix.y, fix.x) - std::atan2(60.0, 80.0);
      EXPECT_NEAR(turned, reference.alignment_error_rad(), 5.0 * c.sigma_m / 100.0);
      EXPECT_NEAR(std::hypot(fix.x, fix.y), 100.0, 5.0 * c.sigma_m);
    }
  }
  EXPECT_EQ(errors.size(), 10U) << "drives share their alignment";
}

TEST(Reference, AlignmentErrorHasTheSpreadOfTwoFixes) {
  const ReferenceConfig c;
  const WorldConfig config = parked();
  constexpr int kDrives = 1000;
  double squared = 0;
  for (std::uint32_t r = 0; r < kDrives; ++r) {
    const double error = Reference(c, config, 5, r).alignment_error_rad();
    squared += error * error;
  }
  const double variance = 2.0 * c.sigma_m * c.sigma_m / (c.alignment_baseline_m * c.alignment_baseline_m);
  EXPECT_NEAR(squared / kDrives / variance, 1.0, 4.0 * std::sqrt(2.0 / kDrives));
}

TEST(Reference, PositionNoiseHasItsSigmaPerAxis) {
  ReferenceConfig c;
  c.excursion_probability = 0.0;
  const WorldConfig config = parked();
  const World world(config, 1, 0);
  const Reference reference(c, config, 1, 0);
  const double cosine = std::cos(reference.alignment_error_rad()), sine = std::sin(reference.alignment_error_rad());
  constexpr int kFixes = 2000;
  double xx = 0, yy = 0, xy = 0;
  for (std::uint32_t k = 0; k < kFixes; ++k) {
    const Fix fix = reference.fix(k, world);
    const double x = cosine * fix.x + sine * fix.y - 80.0, y = -sine * fix.x + cosine * fix.y - 60.0;
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  const double n = kFixes * c.sigma_m * c.sigma_m;
  EXPECT_NEAR(xx / n, 1.0, 4.0 * std::sqrt(2.0 / kFixes));
  EXPECT_NEAR(yy / n, 1.0, 4.0 * std::sqrt(2.0 / kFixes));
  EXPECT_NEAR(xy / n, 0.0, 4.0 / std::sqrt(kFixes));
}

// A moving car: the velocity's noise has its sigma per axis, independent of the position's errors.
TEST(Reference, VelocityNoiseHasItsOwnSigmaAndDoesNotJump) {
  ReferenceConfig c;
  c.sigma_m = 5.0;
  c.excursion_probability = 0.5;
  c.alignment_baseline_m = 10.0;
  WorldConfig config = world_from(
      "objects: [{name: car, x: 80, y: 60, heading: 0.5, speed: 12, reference: true, segments: "
      "[{duration: 200 s}]}]");
  config.duration = Duration::milliseconds(200'000);
  const World world(config, 1, 0);
  const Reference reference(c, config, 1, 0);
  const double cosine = std::cos(reference.alignment_error_rad()), sine = std::sin(reference.alignment_error_rad());
  ASSERT_GT(std::abs(reference.alignment_error_rad()), 0.1)
      << "too well aligned to show whether the velocity is turned";
  constexpr int kFixes = 2000;
  double xx = 0, yy = 0, xy = 0, with_position = 0;
  for (std::uint32_t k = 0; k < kFixes; ++k) {
    const Fix fix = reference.fix(k, world);
    const ObjectState truth = world.state_of(ObjectId{0}, fix.measured);
    const double x = cosine * fix.vx + sine * fix.vy - truth.speed * std::cos(truth.heading),
                 y = -sine * fix.vx + cosine * fix.vy - truth.speed * std::sin(truth.heading);
    xx += x * x;
    yy += y * y;
    xy += x * y;
    with_position += x * (cosine * fix.x + sine * fix.y - truth.x) / std::hypot(c.sigma_m, c.excursion_m);
  }
  const double n = kFixes * reference.velocity_sigma() * reference.velocity_sigma();
  EXPECT_NEAR(xx / n, 1.0, 4.0 * std::sqrt(2.0 / kFixes));
  EXPECT_NEAR(yy / n, 1.0, 4.0 * std::sqrt(2.0 / kFixes));
  EXPECT_NEAR(xy / n, 0.0, 4.0 / std::sqrt(kFixes));
  EXPECT_NEAR(with_position / (kFixes * reference.velocity_sigma()), 0.0, 4.0 / std::sqrt(kFixes));
}

TEST(Reference, ExcursionsLastSeveralFixesAndAreAsOftenAsStated) {
  ReferenceConfig c;
  c.sigma_m = 0.0;
  const WorldConfig config = parked();
  const World world(config, 1, 0);
  const Reference reference(c, config, 1, 0);
  constexpr int kFixes = 5000;
  int away = 0, run = 0;
  double last_x = 0, last_y = 0;
  for (std::uint32_t k = 0; k < kFixes; ++k) {
    const Fix fix = reference.fix(k, world);
    const double x = fix.x - 80.0, y = fix.y - 60.0, size = std::hypot(x, y);
    if (size < 1e-9) {
      EXPECT_TRUE(run == 0 || run >= c.excursion_fixes) << "an excursion ended after " << run << " fixes at " << k;
      run = 0;
    } else {
      EXPECT_NEAR(size, c.excursion_m, 1e-9);
      // One excursion stays in one direction; a second one may begin within it.
      run = run > 0 && (x != last_x || y != last_y) ? c.excursion_fixes : run + 1;
      ++away;
    }
    last_x = x;
    last_y = y;
  }
  // A fix is away unless none of the last n began an excursion; runs of n widen the count's spread by
  // sqrt(n).
  const double expected = 1.0 - std::pow(1.0 - c.excursion_probability, c.excursion_fixes);
  EXPECT_NEAR(away / double{kFixes}, expected,
              4.0 * std::sqrt(c.excursion_fixes * expected * (1.0 - expected) / kFixes));
}

TEST(Reference, AFixIsAFunctionOfItsNumber) {
  const ReferenceConfig c;
  const WorldConfig config = drive("paper_scenario1");
  const World world(config, 1, 0);
  const Reference reference(c, config, 1, 0), again(c, config, 1, 0);
  std::vector<Fix> forwards;
  for (std::uint32_t k = 0; k < 30; ++k) forwards.push_back(reference.fix(k, world));
  for (std::uint32_t k = 30; k-- > 0;) {
    const Fix fix = again.fix(k, world);
    EXPECT_EQ(fix.x, forwards[k].x);
    EXPECT_EQ(fix.y, forwards[k].y);
  }
  EXPECT_NE(Reference(c, config, 2, 0).fix(3, world).x, forwards[3].x);
}

}  // namespace
}  // namespace ttf::sim::world
