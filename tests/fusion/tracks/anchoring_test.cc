// Tracks of cars of drawn sizes. Sensors see their ends, sides, corners or silhouettes. An unknown size stays one error of
// the centre, in every list.
#include "fusion/tracks/anchoring.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fusion/motion/angles.h"
#include "fusion/tracks/tracker.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

using sensors::SeenPoint;
using V = linear::Vector<2>;

struct Car {
  V centre, velocity;
  Box box;
};

// Observes a point of a car with noise of sigma on each axis, and the car's axis and the visible sides.
sensors::Observation seen(const Car& car, SeenPoint point, const V& from, double sigma, RandomStream& noise) {
  const Anchor anchor = anchor_of(point, car.centre, car.box.heading, from);
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
    mean.nees_centre += off.dot(p.ldlt().solve(off)) / kCars;
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

// Two points of an object were seen. Position or size learns, not both at a time. So both are better than they say.
void expect_careful(const Errors& e) {
  EXPECT_GT(e.nees_centre, 1.3);
  EXPECT_LT(e.nees_centre, 2.35);
  EXPECT_GT(e.nees_length, 0.6);
  EXPECT_LT(e.nees_length, 1.25);
}

// A rear alone tells nothing of the length, however often it is seen.
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

TEST(Anchoring, CornersTellBothSides) {
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

// Two sensors face each other. One sees the rear, one the front, and the positions tell the length.
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

// First the rear is seen, then only the side. The anchor moves. The side tells the length.
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

// The states of two points of one body that drives on a circle, at a given angle. The acceleration is left out where the
// motion model has none.
struct Circling {
  double radius = 20.0, rate = 0.5, angle = 0.7;
  bool accelerates = true;
  Box box{{4.6, 1.8}, 0.0};

  double heading() const { return angle + 0.5 * 3.14159265358979323846; }
  // A point along and across from the centre, in the car's axes.
  estimators::State of(double along, double across) const {
    const V u(std::cos(heading()), std::sin(heading())), n(-u.y(), u.x());
    const V arm = radius * V(std::cos(angle), std::sin(angle)) + along * u + across * n;
    estimators::State x = estimators::State::Zero();
    x << V(50.0, 3.0) + arm, rate * V(-arm.y(), arm.x()), (accelerates ? -rate * rate : 0.0) * arm;
    return x;
  }
  // The centre, from the exact motion of an anchor.
  Centre seen_at(const Anchor& anchor, const Heading& axis) const {
    estimators::Cartesian estimate;
    estimate.x = of(0.5 * anchor.along * box.size(0), 0.5 * anchor.across * box.size(1));
    estimate.p.diagonal() << 1e-12, 1e-12, 1e-12, 1e-12, accelerates ? 1e-12 : 0.0, accelerates ? 1e-12 : 0.0;
    Extent extent;
    extent.size = box.size;
    extent.covariance = 1e-12 * Eigen::Matrix2d::Identity();
    return centred(anchor, extent, axis, {}, estimate);
  }
};

Heading known_heading(double value, double rate, double sigma_rate) {
  Heading heading;
  heading.value = value;
  heading.variance = 1e-20;
  heading.known = true;
  heading.rate = rate;
  heading.rate_variance = sigma_rate * sigma_rate;
  return heading;
}

const Anchor kOnCircle[] = {
    {SeenPoint::kEnd, -1, 0}, {SeenPoint::kEnd, 1, 0}, {SeenPoint::kSide, 0, 1}, {SeenPoint::kCorner, -1, -1}};

// The motion knows its turn rate: as of CTRV, CTRA and constant acceleration.
TEST(TurningCentre, FollowsFromAnExactAnchorOnACircle) {
  const Circling car;
  for (const Anchor& anchor : kOnCircle) {
    const Centre centre = car.seen_at(anchor, known_heading(car.heading(), 0.0, 0.3));
    EXPECT_NEAR((centre.estimate.x - car.of(0.0, 0.0)).norm(), 0.0, 1e-5) << int{anchor.along} << int{anchor.across};
    EXPECT_NEAR(motion::to_half_turn(centre.facing.heading - car.heading()), 0.0, 1e-6);
  }
}

// Straight motion knows no turn rate. The heading has one. The acceleration stays unknown.
TEST(TurningCentre, FollowsFromTheHeadingsRateInStraightMotion) {
  Circling car;
  car.accelerates = false;
  for (const Anchor& anchor : kOnCircle) {
    const Centre centre = car.seen_at(anchor, known_heading(car.heading(), car.rate, 1e-6));
    EXPECT_NEAR((centre.estimate.x - car.of(0.0, 0.0)).norm(), 0.0, 1e-5) << int{anchor.along} << int{anchor.across};
    EXPECT_EQ(centre.estimate.p(4, 4), 0.0);
  }
}

// An unknown turn rate is an uncertainty of the velocity, across the lever.
TEST(TurningCentre, SaysThatItsTurnIsUnknown) {
  Circling car;
  car.accelerates = false;
  const Centre centre = car.seen_at({SeenPoint::kEnd, -1, 0}, known_heading(car.heading(), 0.0, 0.3));
  const V u(std::cos(car.heading()), std::sin(car.heading())), n(-u.y(), u.x());
  const linear::Matrix<2> p = centre.estimate.p.block<2, 2>(2, 2);
  EXPECT_NEAR(n.dot(p * n), std::pow(0.3 * 2.3, 2), 1e-3);
  EXPECT_NEAR(u.dot(p * u), 0.0, 1e-9);
}

// The covariance is the sample's of drawn anchors, headings with their rates, and sizes.
TEST(TurningCentre, HasTheCovarianceOfDrawnErrors) {
  constexpr int kDraws = 20000;
  const Circling car;
  const Anchor rear{SeenPoint::kEnd, -1, 0};
  estimators::Cartesian truth;
  truth.x = car.of(-2.3, 0.0);
  truth.p.diagonal() << 0.01, 0.02, 0.04, 0.05, 0.03, 0.02;
  truth.p(0, 2) = truth.p(2, 0) = 0.012;
  truth.p(3, 4) = truth.p(4, 3) = 0.015;
  Heading axis = known_heading(car.heading(), car.rate, 0.05);
  axis.variance = 0.0009;
  axis.covariance = 0.0009;
  Extent extent;
  extent.size = car.box.size;
  extent.covariance << 0.04, 0.005, 0.005, 0.01;
  const Centre stated = centred(rear, extent, axis, {}, truth);
  const linear::Matrix<6> root = truth.p.llt().matrixL();
  const Eigen::Matrix2d size_root = extent.covariance.llt().matrixL();
  RandomStream draw({.seed = 11});
  linear::Matrix<6> sample = linear::Matrix<6>::Zero();
  for (int k = 0; k < kDraws; ++k) {
    estimators::Cartesian drawn = truth;
    linear::Vector<6> e;
    for (double& value : e) value = draw.normal();
    drawn.x += root * e;
    Heading turned = axis;
    const double a = draw.normal(), b = draw.normal();
    turned.value += 0.03 * a;
    turned.rate += axis.covariance / 0.03 * a + std::sqrt(axis.rate_variance - 0.0009 * 0.0009 / 0.0009) * b;
    Extent other = extent;
    const double c = draw.normal(), d = draw.normal();
    other.size += size_root * Eigen::Vector2d(c, d);
    const linear::Vector<6> off = centred(rear, other, turned, {}, drawn).estimate.x - stated.estimate.x;
    sample += off * off.transpose() / kDraws;
  }
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      EXPECT_NEAR(sample(i, j), stated.estimate.p(i, j), 0.06 * std::sqrt(sample(i, i) * sample(j, j))) << i << j;
}

// Every anchor, with and without acceleration, under a heading that is sure, half lost and lost.
TEST(CentrePosition, HasTheBitsOfTheWholeCentre) {
  Track track;
  track.shown = {4.0, 0.01, true};
  track.heading = known_heading(0.6, 0.1, 0.05);
  track.heading.covariance = 1e-4;
  estimators::Cartesian estimate;
  for (const bool accelerates : {false, true}) {
    estimate.x << 20.0, 6.0, 9.0, 7.0, accelerates ? 0.5 : 0.0, accelerates ? -1.5 : 0.0;
    linear::Matrix<6> root = linear::Matrix<6>::Zero();
    const Eigen::Index known = accelerates ? 6 : 4;
    for (Eigen::Index i = 0; i < known; ++i)
      for (Eigen::Index k = 0; k <= i; ++k)
        root(i, k) = 0.1 + 0.03 * static_cast<double>(i) - 0.05 * static_cast<double>(k);
    estimate.p = root * root.transpose();
    for (const Anchor& anchor : {Anchor{}, Anchor{.point = SeenPoint::kEnd, .along = -1},
                                 Anchor{.point = SeenPoint::kCorner, .along = 1, .across = -1},
                                 Anchor{.point = SeenPoint::kSilhouette, .from = {0.0, 0.5}}})
      for (const double sigma : {0.02, 0.3, 2.0}) {
        track.anchor = anchor;
        track.heading.variance = sigma * sigma;
        const Centre whole = centred(track, estimate);
        const CentrePosition part = centre_position(track, estimate);
        EXPECT_EQ(part.estimate.x, whole.estimate.x.head<2>()) << accelerates << sigma;
        EXPECT_EQ(part.estimate.p, (whole.estimate.p.topLeftCorner<2, 2>())) << accelerates << sigma;
        EXPECT_EQ(part.facing.heading, whole.facing.heading);
      }
  }
}

// The heading of a silhouette is lost little by little. Its centre never jumps.
TEST(LostHeading, MovesTheCentreContinuously) {
  const Anchor anchor{.point = SeenPoint::kSilhouette, .from = {0.0, 0.0}};
  estimators::Cartesian estimate;
  estimate.x << 20.0, 6.0, 0.0, 0.0, 0.0, 0.0;
  estimate.p.topLeftCorner<4, 4>() = 0.01 * linear::Matrix<4>::Identity();
  const Scalar shown{4.0, 0.01, true};
  for (const double heading : {0.2, 0.9, 1.6}) {
    Heading axis = known_heading(heading, 0.0, 0.0);
    estimators::Cartesian before;
    for (int step = 0; step <= 1000; ++step) {
      axis.variance = std::pow(0.001 * step, 2) + 1e-9;
      const estimators::Cartesian now = centred(anchor, Extent(), axis, shown, estimate).estimate;
      if (step > 0) {
        EXPECT_LT((now.x - before.x).norm(), 0.02) << heading << " sigma " << 0.001 * step;
        EXPECT_LT((now.p - before.p).norm(), 0.05) << heading << " sigma " << 0.001 * step;
      }
      before = now;
    }
  }
}

// A radar's centre, referred to the rear: with range rate, of an object beside the radar.
TEST(MovedRadar, TakesTheRangeRateAlong) {
  Track track;
  linear::Gaussian<4> state;
  state.x << 10.0, 2.0, 8.0, -3.0;
  state.p = 0.01 * linear::Matrix<4>::Identity();
  track.estimate = state;
  track.anchor = {SeenPoint::kEnd, -1, 0};
  const double heading = std::atan2(-3.0, 8.0);
  track.heading = known_heading(heading, 0.0, 0.0);
  track.extent.covariance.setZero();
  const V rear = state.x.head<2>(), velocity = state.x.tail<2>();
  const auto radar = [&](const V& at) {
    sensors::Observation z;
    z.kind = sensors::ObservationKind::kRangeBearingRate;
    z.z << at.norm(), std::atan2(at.y(), at.x()), at.normalized().dot(velocity);
    z.r.diagonal() << 0.01, 1e-4, 0.01;
    return z;
  };
  const auto estimator = estimators::make_estimator({});
  for (const double length : {0.5, 2.0}) {
    track.extent.size(0) = length;
    const sensors::Observation centre = radar(rear + 0.5 * length * velocity.normalized());
    const std::optional<Distance> distance = distance_to(track, *estimator, centre, {});
    ASSERT_TRUE(distance);
    const sensors::Observation moved = counted(centre, *distance, {}, linear::Matrix<2>::Zero());
    // To first order in the lever.
    EXPECT_NEAR((moved.z - radar(rear).z).norm(), 0.0, 0.05 * length * length);
    EXPECT_NEAR(moved.z(2), radar(rear).z(2), 0.02 * length * length);
  }
  sensors::Observation nowhere = radar(rear);
  nowhere.z(0) = 0.0;
  const std::optional<Distance> distance = distance_to(track, *estimator, nowhere, {});
  ASSERT_TRUE(distance);
  EXPECT_TRUE(counted(nowhere, *distance, {}, linear::Matrix<2>::Identity()).z.allFinite());
  EXPECT_TRUE(expected(nowhere, *distance, {}).r.allFinite());
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
}  // namespace ttf::fusion::tracks
