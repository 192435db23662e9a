// The centre of an object that turns about the point that its track follows, and of one whose heading is lost.
#include "fusion/tracks/body/centre.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/random.h"
#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;
using V = linear::Vector<2>;

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

// The motion has its turn rate: as of CTRV, CTRA and constant acceleration.
TEST(TurningCentre, FollowsFromAnExactAnchorOnACircle) {
  const Circling car;
  for (const Anchor& anchor : kOnCircle) {
    const Centre centre = car.seen_at(anchor, known_heading(car.heading(), 0.0, 0.3));
    EXPECT_NEAR((centre.estimate.x - car.of(0.0, 0.0)).norm(), 0.0, 1e-5) << int{anchor.along} << int{anchor.across};
    EXPECT_NEAR(motion::to_half_turn(centre.facing.heading - car.heading()), 0.0, 1e-6);
  }
}

// Straight motion has no turn rate. The heading has one. The acceleration stays unknown.
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
  Body body;
  body.shown = {4.0, 0.01, true};
  body.heading = known_heading(0.6, 0.1, 0.05);
  body.heading.covariance = 1e-4;
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
        body.anchor = anchor;
        body.heading.variance = sigma * sigma;
        const Centre whole = centred(body, estimate);
        const CentrePosition part = centre_position(body, estimate);
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

}  // namespace
}  // namespace ttf::fusion::tracks::body
