// Fields and their edges, and objects that hide others, against lines of sight in small steps.
#include "fusion/tracks/parts/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/fusion/scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::tracks::parts {
namespace {

struct Car {
  double x = 0.0, y = 0.0, heading = 0.0, length = 4.4, width = 1.8;
};

// A standing object of known outline.
Track track_of(const Car& car, double sigma = 0.05, bool confirmed = true) {
  Track track;
  track.birth = track.newest = {{SensorId{1}, 0}, 0, at_ms(0)};
  linear::Gaussian<4> estimate;
  estimate.x << car.x, car.y, 0.0, 0.0;
  estimate.p.diagonal() << sigma * sigma, sigma * sigma, 0.01, 0.01;
  track.estimate = estimate;
  track.heading = {{car.heading, 1e-4, true}};
  track.extent = body::Extent({.length = car.length, .length_sigma = 0.1, .width = car.width, .width_sigma = 0.1});
  track.confirmed = confirmed;
  return track;
}

config::TrackerConfig seeing(const std::optional<sensors::Field>& field, const sensors::Mounting& mounting = {}) {
  config::TrackerConfig config;
  config.sensors.resize(1);
  config.sensors[0].mounting = mounting;
  config.sensors[0].field = field;
  return config;
}

std::vector<double> judged(const config::TrackerConfig& config, const std::vector<Track>& tracks) {
  Visibility visibility(config, tracks.size());
  visibility.judge(tracks, *estimators::make_estimator(config), SensorId{0});
  std::vector<double> result;
  for (std::size_t t = 0; t < tracks.size(); ++t) result.push_back(visibility.of(t));
  return result;
}
double judged(const config::TrackerConfig& config, const Car& car, double sigma = 0.05) {
  return judged(config, std::vector<Track>{track_of(car, sigma)})[0];
}

constexpr sensors::Field kCamera{.half_angle = 0.45, .min_range = 2.0, .max_range = 90.0};

TEST(Visibility, WithoutAKnownFieldEverythingIsVisible) {
  const std::vector<Track> tracks{track_of({-20.0, 3.0}), track_of({10.0, 0.0}), track_of({400.0, 0.0})};
  EXPECT_EQ(judged(seeing(std::nullopt), tracks), (std::vector<double>{1.0, 1.0, 1.0}));
  EXPECT_EQ(judged(config::TrackerConfig{}, tracks), (std::vector<double>{1.0, 1.0, 1.0}));
  EXPECT_NEAR(judged(seeing(sensors::Field{}), {-20.0, 3.0}), 1.0, 1e-9) << "a field without bounds";
}

TEST(Visibility, TheFieldHasAHalfAngleAndTwoRanges) {
  const config::TrackerConfig config = seeing(kCamera);
  EXPECT_GT(judged(config, {30.0, 0.0}), 0.999);
  EXPECT_GT(judged(config, {30.0, 10.0}), 0.999);
  EXPECT_LT(judged(config, {20.0, 17.0}), 1e-3) << "40 degrees aside";
  EXPECT_LT(judged(config, {20.0, -17.0}), 1e-3);
  EXPECT_LT(judged(config, {-30.0, 0.0}), 1e-3);
  EXPECT_LT(judged(config, {110.0, 0.0}), 1e-3);
  EXPECT_GT(judged(config, {80.0, 0.0}), 0.99);
  EXPECT_LT(judged(config, {1.5, 0.0, 0.0, 1.0, 1.0}), 0.01);
}

// A middle on the edge is in the field every other time. The sum over both sides of an edge is one.
TEST(Visibility, EdgesAreSoft) {
  const config::TrackerConfig config = seeing(kCamera);
  const auto at = [](double bearing, double range) {
    return Car{range * std::cos(bearing), range * std::sin(bearing), bearing};
  };
  EXPECT_NEAR(judged(config, at(0.45, 40.0)), 0.5, 1e-6);
  EXPECT_NEAR(judged(config, at(0.46, 40.0)) + judged(config, at(0.44, 40.0)), 1.0, 1e-6);
  // The bearing's variance by hand: 0.5 m across at 40 m, and the width of 1.8 m.
  const double sigma = std::sqrt((0.5 * 0.5 + 1.8 * 1.8 / 12.0)) / 40.0;
  EXPECT_NEAR(judged(config, at(0.46, 40.0), 0.5), 0.5 * std::erfc(0.01 / sigma / std::sqrt(2.0)), 1e-9);
  EXPECT_NEAR(judged(config, at(0.1, 92.2)), 0.5, 1e-6) << "the near side is at the largest range";
}

TEST(Visibility, TheFieldTurnsWithTheSensor) {
  const config::TrackerConfig config = seeing(kCamera, {.position = linear::Vector<2>(1.0, -0.9), .yaw = -0.5 * kPi});
  EXPECT_GT(judged(config, {1.0, -15.0}), 0.999);
  EXPECT_LT(judged(config, {15.0, -0.9}), 1e-3);
  EXPECT_LT(judged(config, {1.0, 15.0}), 1e-3);
}

TEST(Visibility, TheOwnVehicleHidesSectors) {
  sensors::Field field = kCamera;
  field.blind[field.blind_sectors++] = {0.2, 0.4};
  const config::TrackerConfig config = seeing(field, {.position = linear::Vector<2>(0.0, 0.0), .yaw = 0.1});
  const auto at = [](double bearing) { return Car{40.0 * std::cos(bearing), 40.0 * std::sin(bearing), bearing}; };
  EXPECT_LT(judged(config, at(0.4)), 1e-3);
  EXPECT_NEAR(judged(config, at(0.3)), 0.5, 1e-6);
  EXPECT_GT(judged(config, at(0.2)), 0.999);
}

TEST(Visibility, ANearerObjectHides) {
  const config::TrackerConfig config = seeing(kCamera);
  const Car lorry{20.0, 0.0, 0.0, 10.0, 2.5}, behind{40.0, 1.0}, beside{40.0, 9.0}, before{9.0, 0.0};
  const std::vector<double> seen =
      judged(config, {track_of(behind), track_of(lorry), track_of(beside), track_of(before)});
  EXPECT_LT(seen[0], 0.01);
  EXPECT_LT(seen[1], 0.01) << "by the one before it";
  EXPECT_GT(seen[2], 0.99);
  EXPECT_GT(seen[3], 0.99);
  // A tentative track may be clutter, and hides nothing.
  EXPECT_GT(judged(config, {track_of(behind), track_of(lorry, 0.05, false)})[0], 0.99);
  // Two tracks of one object hide each other as little as the object hides itself.
  EXPECT_GT(judged(config, {track_of({21.0, 0.3}), track_of({20.0, 0.0})})[0], 0.99);
  // The middle at the outline's edge, at a bearing of 1.25 / 15.
  EXPECT_NEAR(judged(config, {track_of({45.0, 3.75}), track_of(lorry)})[0], 0.5, 0.01);
}

TEST(Visibility, AnObjectHidesByItsExistence) {
  config::TrackerConfig config = seeing(kCamera);
  config.birth = config::Birth::kExistence;
  std::vector<Track> tracks{track_of({40.0, 0.0}), track_of({20.0, 0.0})};
  tracks[1].existence = 0.7;
  EXPECT_NEAR(judged(config, tracks)[0], 0.3, 0.01);
}

// From a mast the camera sees over an object: at 20 m it hides what is nearer than 30 m.
TEST(Visibility, AShadowHasAnEnd) {
  sensors::Field mast = kCamera;
  mast.shadow = 0.5;
  const Track near = track_of({20.9, 0.0, 0.0, 1.8, 1.8});
  EXPECT_LT(judged(seeing(mast), {track_of({28.0, 0.0}), near})[0], 0.05);
  EXPECT_GT(judged(seeing(mast), {track_of({32.0, 0.0}), near})[0], 0.99);
  mast.shadow = 0.0;
  EXPECT_GT(judged(seeing(mast), {track_of({28.0, 0.0}), near})[0], 0.99);
}

TEST(Visibility, ATentativeTrackIsWhereItsSensorSawIt) {
  const config::TrackerConfig config = seeing(kCamera);
  Track track = track_of({20.0, 17.0}, 0.05, false);
  track.newest.measurement.sensor = SensorId{0};
  EXPECT_EQ(judged(config, {track})[0], 1.0);
  track.newest.measurement.sensor = SensorId{1};
  EXPECT_LT(judged(config, {track})[0], 1e-3);
}

TEST(Visibility, OnlyWhoWasNotObservedIsJudged) {
  const config::TrackerConfig config = seeing(kCamera);
  const std::vector<Track> tracks{track_of({20.0, 17.0}), track_of({20.0, -17.0})};
  Visibility visibility(config, 2);
  const int observation_of[] = {3, -1};
  visibility.judge(tracks, *estimators::make_estimator(config), SensorId{0}, observation_of);
  EXPECT_EQ(visibility.of(0), 1.0);
  EXPECT_LT(visibility.of(1), 1e-3);
}

bool holds(const Car& car, double x, double y) {
  const double dx = x - car.x, dy = y - car.y, c = std::cos(car.heading), s = std::sin(car.heading);
  return std::abs(c * dx + s * dy) < 0.5 * car.length && std::abs(-s * dx + c * dy) < 0.5 * car.width;
}
bool overlap(const Car& a, const Car& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < 0.5 * (a.length + b.length) + 2.0;
}

// Cars anywhere around the sensor that do not overlap.
std::vector<Car> drawn(std::uint64_t seed, std::size_t count) {
  RandomStream stream({.seed = seed});
  std::vector<Car> cars;
  while (cars.size() < count) {
    const Car car{stream.uniform(-60.0, 60.0), stream.uniform(-60.0, 60.0), stream.uniform(-3.0, 3.0),
                  stream.uniform(3.0, 10.0), stream.uniform(1.5, 2.5)};
    if (std::hypot(car.x, car.y) > 8.0 &&
        std::none_of(cars.begin(), cars.end(), [&](const Car& other) { return overlap(car, other); }))
      cars.push_back(car);
  }
  return cars;
}

TEST(Visibility, IsThatOfLinesOfSightInSmallSteps) {
  const config::TrackerConfig config = seeing(sensors::Field{});
  int seen = 0, unseen = 0, unclear = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Car> cars = drawn(seed, 40);
    std::vector<Track> tracks;
    for (const Car& car : cars) tracks.push_back(track_of(car, 0.01));
    const std::vector<double> visible = judged(config, tracks);
    for (std::size_t i = 0; i < cars.size(); ++i) {
      bool hidden = false;
      for (int step = 0; step < 4000 && !hidden; ++step)
        for (std::size_t j = 0; j < cars.size() && !hidden; ++j)
          hidden = j != i && holds(cars[j], cars[i].x * step / 4000.0, cars[i].y * step / 4000.0);
      if (visible[i] > 0.2 && visible[i] < 0.8) {
        ++unclear;
        continue;
      }
      ASSERT_EQ(visible[i] < 0.5, hidden) << "seed " << seed << ", car " << i << ": " << visible[i];
      ++(hidden ? unseen : seen);
    }
  }
  EXPECT_GT(seen, 150);
  EXPECT_GT(unseen, 150);
  EXPECT_LT(unclear, 400);
}

TEST(Visibility, DoesNotDependOnTheOrderOfTracks) {
  const config::TrackerConfig config = seeing(sensors::Field{});
  std::vector<Track> tracks;
  for (const Car& car : drawn(3, 60)) tracks.push_back(track_of(car, 0.3));
  const std::vector<double> visible = judged(config, tracks);
  std::reverse(tracks.begin(), tracks.end());
  std::vector<double> reversed = judged(config, tracks);
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(visible, reversed);
}

TEST(Visibility, AllocatesNothingAfterConstruction) {
  const config::TrackerConfig config = seeing(sensors::Field{});
  std::vector<Track> tracks;
  for (const Car& car : drawn(4, 60)) tracks.push_back(track_of(car));
  const auto estimator = estimators::make_estimator(config);
  Visibility visibility(config, tracks.size());
  const std::int64_t before = support::allocations();
  visibility.judge(tracks, *estimator, SensorId{0});
  EXPECT_EQ(support::allocations() - before, 0);
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
