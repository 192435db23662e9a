// Tracks of cars of drawn sizes. Sensors see their ends, sides, corners or silhouettes. An unknown size stays one error of
// the centre, in every list.
#include "fusion/tracks/parts/referral.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

using sensors::SeenPoint;
using V = linear::Vector<2>;

struct Car {
  V centre, velocity;
  body::Box box;
};

// Observes a point of a car with noise of sigma on each axis, and the car's axis and the visible sides.
sensors::Observation seen(const Car& car, SeenPoint point, const V& from, double sigma, RandomStream& noise) {
  const body::Anchor anchor = body::anchor_of(point, car.centre, car.box.heading, from);
  const V at = point_of(anchor, {}, car.centre, car.box)->at;
  const double off_y = sigma * noise.normal(), off_x = sigma * noise.normal();  // in this order with any compiler
  sensors::Observation z = position(at.x() + off_x, at.y() + off_y, sigma);
  z.seen = point;
  if (point == SeenPoint::kSilhouette) return z;
  z.has_heading = true;
  z.sigma_heading = 0.03;
  z.heading = car.box.heading + z.sigma_heading * noise.normal();
  const auto side = [&](Eigen::Index k, double& value, double& its_sigma) {
    its_sigma = 0.1;
    value = car.box.size(k) + its_sigma * noise.normal();
    return true;
  };
  if (point != SeenPoint::kEnd) z.has_length = side(0, z.length, z.sigma_length);
  if (point != SeenPoint::kSide) z.has_width = side(1, z.width, z.sigma_width);
  return z;
}

struct Errors {
  double nees_centre = 0.0, nees_length = 0.0, face = 0.0, sigma_length = 0.0, variance_centre = 0.0;
};

// Draws cars of the configuration's prior. A tracker sees a point of each, 20 lists a second. The errors are means over the
// cars after the last list. The face is the rear.
struct Look {
  SeenPoint point;
  V from;
};
Errors follow(const config::TrackerConfig& config, int lists, const std::function<Look(int)>& look, double heading,
              const std::vector<sensors::KnownSensor>& sensors = {}) {
  constexpr int kCars = 300;
  Errors mean;
  for (int c = 0; c < kCars; ++c) {
    RandomStream draw({.seed = 5, .replication = static_cast<std::uint32_t>(c)});
    const config::Sizes& s = config.sizes;
    Car car{{30.0, 4.0}, 8.0 * V(std::cos(heading), std::sin(heading)), {{}, heading}};
    const double first = draw.normal(), second = draw.normal();
    car.box.size << s.length + s.length_sigma * first,
        s.width + s.width_sigma * (s.correlation * first + std::sqrt(1 - s.correlation * s.correlation) * second);
    config::TrackerConfig own = config;
    own.sensors = sensors;
    Tracker tracker(own, 4);
    TrackSet set(tracker.max_tracks());
    for (int k = 0; k < lists; ++k) {
      const Look at = look(k);
      std::uint8_t id = 0;
      for (std::size_t i = 0; i < sensors.size(); ++i)
        if (sensors[i].mounting.position == at.from) id = static_cast<std::uint8_t>(i);
      sensors::Observation z = seen(car, at.point, at.from, 0.05, draw);
      z.sensor = static_cast<SensorId>(id);
      if (id < sensors.size()) z.from = sensors[id].mounting;
      tracker.step(set, list_of(id, static_cast<std::uint32_t>(k), at_ms(50 * k), {z}).view());
      if (k + 1 < lists) car.centre += 0.05 * car.velocity;
    }
    EXPECT_EQ(set.tracks.size(), 1u);
    if (set.tracks.empty()) continue;
    const Track& track = set.tracks.front();
    const TrackView view = view_of(track, set.time, set.time, own, tracker.estimator());
    const V off = view.state.head<2>() - car.centre;
    const linear::Matrix<2> p = view.covariance.topLeftCorner<2, 2>();
    const V u(std::cos(heading), std::sin(heading)), v(std::cos(view.heading), std::sin(view.heading));
    const V rear = view.state.head<2>() - 0.5 * view.length * v, true_rear = car.centre - 0.5 * car.box.size(0) * u;
    const double length = view.length - car.box.size(0);
    mean.nees_centre += norm_squared(off, p) / kCars;
    mean.nees_length += length * length / (view.sigma_length * view.sigma_length) / kCars;
    mean.face += (rear - true_rear).squaredNorm() / kCars;
    mean.sigma_length += view.sigma_length / kCars;
    mean.variance_centre += u.dot(p * u) / kCars;
  }
  return mean;
}

config::TrackerConfig calm() {
  config::TrackerConfig config;
  config.process_noise = 1e-4;
  config.heading_noise = config.turn_noise = 1e-4;
  config.initial_turn_rate_sigma = 0.01;
  config.gate_probability = 0.999999;
  return config;
}

// Intervals of the mean of 300 NEES of 2 and of 1 degree of freedom. Linearisation widens them a little.
void expect_consistent(const Errors& e) {
  EXPECT_GT(e.nees_centre, 1.7);
  EXPECT_LT(e.nees_centre, 2.35);
  EXPECT_GT(e.nees_length, 0.8);
  EXPECT_LT(e.nees_length, 1.25);
}

// Two points of an object were seen. Position or size is corrected, not both at a time. So both are better than they say.
void expect_careful(const Errors& e) {
  EXPECT_GT(e.nees_centre, 1.3);
  EXPECT_LT(e.nees_centre, 2.35);
  EXPECT_GT(e.nees_length, 0.6);
  EXPECT_LT(e.nees_length, 1.25);
}

// A rear alone gives no length, however often it is seen.
TEST(Anchoring, ARearSeenTwoHundredTimesLeavesTheLengthUnknown) {
  const config::TrackerConfig config = calm();
  const Errors e = follow(
      config, 200,
      [](int) {
        return Look{SeenPoint::kEnd, {0.0, 0.0}};
      },
      0.0);
  expect_consistent(e);
  EXPECT_NEAR(e.sigma_length, config.sizes.length_sigma, 1e-12);
  EXPECT_LT(e.face, 0.0005);
  EXPECT_NEAR(e.variance_centre, 0.25 * 0.25, 0.002) << "half the length's spread";
}

// So does a camera beside it, which sees the silhouette of a car straight ahead.
TEST(Anchoring, RearAndSilhouetteAreOnePlace) {
  const Errors e = follow(
      calm(), 200,
      [](int k) {
        return Look{k % 2 ? SeenPoint::kSilhouette : SeenPoint::kEnd, {0.0, 0.0}};
      },
      0.0);
  expect_careful(e);
  EXPECT_LT(e.face, 0.0007);
  EXPECT_GT(e.sigma_length, 0.1);
}

// A car turns its side. The place of its silhouette moves over it, and the motion model allows for that.
TEST(Anchoring, SilhouettesAloneFollowTheirOwnPlace) {
  for (const double heading : {0.0, 0.6, 1.6}) {
    config::TrackerConfig config = calm();
    config.process_noise = 0.3;
    const Errors e = follow(
        config, 60,
        [](int) {
          return Look{SeenPoint::kSilhouette, {0.0, 0.0}};
        },
        heading);
    EXPECT_GT(e.nees_centre, 1.3) << heading;
    EXPECT_LT(e.nees_centre, 2.5) << heading;
  }
}

TEST(Anchoring, CornersMeasureBothSides) {
  const Errors e = follow(
      calm(), 60,
      [](int) {
        return Look{SeenPoint::kCorner, {0.0, 0.0}};
      },
      0.7);
  EXPECT_LT(e.sigma_length, 0.11);
  EXPECT_LT(e.face, 0.02);
  EXPECT_GT(e.nees_centre, 1.0);
  EXPECT_LT(e.nees_centre, 2.5);
}

// Two sensors face each other. One sees the rear, one the front, and the positions give the length.
TEST(Anchoring, TheOtherEndTeachesTheLength) {
  sensors::KnownSensor behind, before;
  before.mounting.position = {120.0, 4.0};
  const Errors e = follow(calm(), 100,
                          [](int k) {
                            return Look{SeenPoint::kEnd, k % 2 ? V(120.0, 4.0) : V(0.0, 0.0)};
                          },
                          0.0, {behind, before});
  expect_careful(e);
  EXPECT_LT(e.sigma_length, 0.1);
}

// First the rear is seen, then only the side. The anchor moves. The side gives the length.
TEST(Anchoring, TheAnchorFollowsWhatIsSeen) {
  const Errors e = follow(
      calm(), 80,
      [](int k) {
        return Look{k < 40 ? SeenPoint::kEnd : SeenPoint::kSide, {0.0, 0.0}};
      },
      0.8);
  EXPECT_LT(e.sigma_length, 0.11);
  EXPECT_GT(e.nees_centre, 1.0);
  EXPECT_LT(e.nees_centre, 2.5);
}

TEST(Anchoring, CentresAreLeftAlone) {
  const Errors e = follow(
      calm(), 40,
      [](int) {
        return Look{SeenPoint::kCentre, {0.0, 0.0}};
      },
      0.3);
  EXPECT_GT(e.nees_centre, 1.7);
  EXPECT_LT(e.nees_centre, 2.35);
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
