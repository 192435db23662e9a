// Detections that two bodies share: sampled returns of two cars side by side, joined to one detection.
#include "fusion/tracks/resolution/unresolved.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>

#include "tests/fusion/scenes.h"
#include "tests/fusion/tracks/body/drawn_outline.h"

namespace ttf::fusion::tracks::resolution {
namespace {

using body::DrawnOutline;

constexpr SensorId kRadar{0}, kLaser{1};
constexpr sensors::Resolution kJoins{5.0, 2.5, 0.003, 1.0, 0.0, 60.0};
constexpr double kAcceleration = 0.05;  // spectral density [m^2/s^3]

struct Car {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;
  void drive(double dt, RandomStream& noise) {
    const double ax = std::sqrt(kAcceleration * dt) * noise.normal(),
                 ay = std::sqrt(kAcceleration * dt) * noise.normal();
    x += dt * (vx + 0.5 * ax);
    y += dt * (vy + 0.5 * ay);
    vx += ax;
    vy += ay;
  }
};

struct Sum {
  linear::Vector<3> of = linear::Vector<3>::Zero();
  int returns = 0;
  void add(const Car& car, int points, RandomStream& noise) {
    const double heading = std::atan2(car.vy, car.vx);
    const DrawnOutline outline({car.x, car.y}, {{4.4, 1.8}, heading});
    for (int i = 0; i < points; ++i) {
      const linear::Vector<2> at = outline.draw(noise);
      of += linear::Vector<3>(at(0) + 0.15 * noise.normal(), at(1) + 0.003 * noise.normal(),
                              body::range_rate_of(at, {car.x, car.y}, {car.vx, car.vy}, 0.0) + 0.05 * noise.normal());
      ++returns;
    }
  }
  sensors::Observation detection() const {
    const double root = std::sqrt(returns);
    sensors::Observation z =
        radar(of(0) / returns, of(1) / returns, of(2) / returns, 0.15 / root, 0.003 / root, 0.05 / root);
    z.seen = sensors::SeenPoint::kSilhouette;
    z.sensor = kRadar;
    z.returns = static_cast<std::uint8_t>(returns);
    return z;
  }
};

config::TrackerConfig with_radar(bool resolution) {
  config::TrackerConfig config = config_of(config::MotionModel::kConstantVelocity, kAcceleration);
  config.sensors.resize(2);
  if (resolution) config.sensors[0].resolution = kJoins;
  return config;
}

sensors::Observation box_of(const Car& car, RandomStream& noise) {
  sensors::Observation z = position(car.x + 0.05 * noise.normal(), car.y + 0.05 * noise.normal(), 0.05);
  z.sensor = kLaser;
  z.has_heading = z.has_length = z.has_width = true;
  z.heading = std::atan2(car.vy, car.vx) + 0.02 * noise.normal();
  z.sigma_heading = 0.02;
  z.length = 4.4;
  z.width = 1.8;
  z.sigma_length = z.sigma_width = 0.05;
  return z;
}

// Two cars drive off at one speed, `apart` from each other across. A laser sees them for a second, then the radar alone. Its list has
// the returns of both in one detection, if `joined`.
struct Drive {
  TrackSet set;
  std::array<Car, 2> cars;
  std::vector<std::array<std::size_t, 2>> identities;  // the tracks' births, by car, from list to list

  Drive(std::uint32_t number, const config::TrackerConfig& config, double apart, bool joined, double seconds)
      : set(Tracker(config, 4).max_tracks()) {
    RandomStream noise({3, number, Purpose::kTest, 0, 0});
    Tracker tracker(config, 4);
    cars = {Car{20.0, 0.5 * apart, 6.0, 0.0}, Car{20.0, -0.5 * apart, 6.0, 0.0}};
    std::uint32_t sequence = 0;
    for (int k = 0; k * 0.05 < 1.0 + seconds; ++k) {
      for (Car& car : cars) car.drive(0.05, noise);
      std::vector<sensors::Observation> list;
      const bool lasers = k < 20;
      if (lasers) {
        for (const Car& car : cars) list.push_back(box_of(car, noise));
      } else {
        std::array<Sum, 2> of;
        for (std::size_t c = 0; c < 2; ++c)
          of[joined ? 0 : c].add(cars[c], static_cast<int>(noise.integer(1, 4)), noise);
        for (const Sum& sum : of)
          if (sum.returns > 0) list.push_back(sum.detection());
      }
      tracker.step(set, {{lasers ? kLaser : kRadar, sequence++}, at_ms(50 * k), list});
    }
  }
  // The view of the track with the car's first observation.
  std::optional<TrackView> of(std::size_t car, const config::TrackerConfig& config) const {
    for (const Track& track : set.tracks)
      if (track.confirmed && track.birth.index == car && index_of(track.birth.measurement.sensor) == 1)
        return shown(track, set.time, set.time, config);
    return std::nullopt;
  }
};

TEST(Unresolved, CarsSideBySideKeepTheirIdentitiesAndAreConsistent) {
  const config::TrackerConfig config = with_radar(true);
  constexpr int kDrives = 60;
  double squares = 0.0;
  int judged = 0;
  for (std::uint32_t number = 0; number < kDrives; ++number) {
    const Drive drive(number, config, 3.5, true, 5.0);
    EXPECT_EQ(confirmed(drive.set), 2) << number;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::optional<TrackView> view = drive.of(c, config);
      ASSERT_TRUE(view) << number << ": " << c;
      const Car& car = drive.cars[c];
      linear::Vector<4> off;
      off << view->state(0) - car.x, view->state(1) - car.y, view->state(2) - car.vx, view->state(3) - car.vy;
      const linear::Matrix<4> p = view->covariance.topLeftCorner<4, 4>();
      EXPECT_LT(std::abs(off(1)), 4.0 * std::sqrt(p(1, 1))) << number << ": " << c;
      squares += off.dot(p.inverse() * off);
      ++judged;
    }
  }
  // Chi-square of 4 degrees each; the mean of 120 lies below 4.7 with 0.99.
  EXPECT_LT(squares / judged, 4.7);
  EXPECT_GT(squares / judged, 1.5);
}

TEST(Unresolved, CarsFarApartAreTrackedAsWithoutAResolution) {
  const config::TrackerConfig known = with_radar(true), none = with_radar(false);
  const Drive with(1, known, 10.0, false, 2.0), without(1, none, 10.0, false, 2.0);
  ASSERT_EQ(with.set.tracks.size(), without.set.tracks.size());
  const auto estimator = estimators::make_estimator(none);
  for (std::size_t t = 0; t < with.set.tracks.size(); ++t) {
    const auto a = estimator->cartesian(with.set.tracks[t].estimate),
               b = estimator->cartesian(without.set.tracks[t].estimate);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.p, b.p);
  }
}

TEST(Unresolved, CarsWithADetectionEachAreCorrected) {
  const config::TrackerConfig known = with_radar(true), none = with_radar(false);
  const Drive with(1, known, 3.5, false, 2.0), without(1, none, 3.5, false, 2.0);
  const auto estimator = estimators::make_estimator(none);
  ASSERT_EQ(with.set.tracks.size(), without.set.tracks.size());
  for (std::size_t t = 0; t < with.set.tracks.size(); ++t)
    EXPECT_EQ(estimator->cartesian(with.set.tracks[t].estimate).x,
              estimator->cartesian(without.set.tracks[t].estimate).x);
}

}  // namespace
}  // namespace ttf::fusion::tracks::resolution
