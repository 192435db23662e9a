// The spread of a radar's returns over outlines, against drawn points.
#include "fusion/tracks/body/returns.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "fusion/tracks/body/distance.h"
#include "tests/fusion/scenes.h"
#include "tests/fusion/tracks/body/drawn_outline.h"

namespace ttf::fusion::tracks::body {
namespace {

linear::Matrix<3> by_drawing(const SeenBox& o) {
  constexpr int kPoints = 20'000;
  const DrawnOutline drawn(o.centre, o.box);
  linear::Vector<3> sum = linear::Vector<3>::Zero();
  linear::Matrix<3> squares = linear::Matrix<3>::Zero();
  RandomStream stream({1, 0, Purpose::kTest, 0, 0});
  for (int k = 0; k < kPoints; ++k) {
    const linear::Vector<2> at = drawn.draw(stream);
    const linear::Vector<3> point(at(0), at(1), range_rate_of(at, o.centre, o.velocity, o.turn_rate));
    sum += point;
    squares += point * point.transpose();
  }
  return squares / kPoints - sum * sum.transpose() / (double{kPoints} * kPoints);
}

TEST(Returns, SpreadAsPointsDrawnOnTheOutline) {
  for (const SeenBox& o : {seen_car(45.0, 0.0, 0.0, 3.0), seen_car(20.0, 3.5, 0.0, 8.0), seen_car(60.0, 3.5, 0.0, 8.0),
                           seen_car(25.0, 5.0, 1.5, 5.0), seen_car(30.0, -8.0, 2.4, 8.0, 0.5)}) {
    const linear::Matrix<3> spread = spread_of(o), drawn = by_drawing(o);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(std::sqrt(spread(i, i)), std::sqrt(drawn(i, i)), 0.08 * std::sqrt(drawn(i, i)) + 1e-3)
          << o.centre.transpose() << ": " << i;
    EXPECT_NEAR(spread(0, 1), drawn(0, 1), 0.1 * std::sqrt(drawn(0, 0) * drawn(1, 1)) + 1e-6);
    EXPECT_NEAR(spread(1, 2), drawn(1, 2), 0.1 * std::sqrt(drawn(1, 1) * drawn(2, 2)) + 1e-6);
  }
}

TEST(Returns, AroundTheSensorThereIsNoOutline) { EXPECT_TRUE(spread_of(seen_car(0.0, 0.0, 0.0, 1.0)).isZero(0.0)); }

// A car almost end-on, whose course alone tells the heading: the rear and, turned a little, a side as well. Headings are drawn as
// the track states them, and returns on the outline turned so. Returns the mean d2, of three degrees of freedom, of the
// innovation by its stated covariance; the anchor's place is exact.
double mean_squared_distance(const Anchor& anchor, double aspect, double sigma, int returns) {
  constexpr int kDraws = 1'000;
  constexpr double kFast = 8.0;
  const auto estimator = estimators::make_estimator({});
  const linear::Vector<2> at(40.0, 0.0), along(std::cos(aspect), std::sin(aspect)), left(-along.y(), along.x());
  const linear::Matrix<2> unsure = sigma * sigma * kFast * kFast * left * left.transpose();
  Body body;
  body.anchor = anchor;
  body.extent.covariance.setZero();
  linear::Gaussian<4> state;
  state.x << at, kFast * along;
  state.p.setZero();
  state.p.bottomRightCorner<2, 2>() = unsure;
  body.estimate = state;
  RandomStream stream({6, 0, Purpose::kTest, 0, 0});
  double sum = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const double across = sigma * stream.normal();
    const linear::Vector<2> velocity = kFast * (along + across * left), ahead = velocity.normalized();
    const Box box{body.extent.size, std::atan2(velocity.y(), velocity.x())};
    linear::Vector<2> centre = at + 0.5 * box.size(0) * ahead;
    if (anchor.point == sensors::SeenPoint::kSilhouette)
      for (int step = 0; step < 2; ++step) centre += at - plane_of(DrawnOutline(centre, box).mean());
    const DrawnOutline outline(centre, box);
    linear::Vector<3> mean = linear::Vector<3>::Zero();
    for (int i = 0; i < returns; ++i) {
      const linear::Vector<2> point = outline.draw(stream);
      mean += linear::Vector<3>(point(0) + 0.1 * stream.normal(), point(1) + 0.003 * stream.normal(),
                                range_rate_of(point, centre, velocity, 0.0) + 0.05 * stream.normal()) /
              returns;
    }
    const double root = std::sqrt(returns);
    sensors::Observation z = radar(mean(0), mean(1), mean(2), 0.1 / root, 0.003 / root, 0.05 / root);
    z.seen = sensors::SeenPoint::kSilhouette;
    z.sensor = SensorId{0};
    z.returns = static_cast<std::uint8_t>(returns);
    z = with_spread(z, body, *estimator, {});
    if (const std::optional<Distance> distance = distance_to(body, *estimator, z, {})) z = expected(z, *distance, {});
    const linear::Vector<3> off = z.z - linear::Vector<3>(at.x(), 0.0, kFast * along.x());
    z.r(2, 2) += unsure(0, 0);
    sum += off.dot(z.r.inverse() * off);
  }
  return sum / kDraws;
}

TEST(Returns, LieWithinTheirCovarianceWhereTheHeadingIsUncertainNearEndOn) {
  const Anchor silhouette{sensors::SeenPoint::kSilhouette, 0, 0, SensorId{0}}, rear{sensors::SeenPoint::kEnd, -1, 0};
  for (const double aspect : {0.0, 0.05, 0.1, 0.3})
    for (const double sigma : {0.05, 0.08, 0.1})
      for (const int returns : {1, 2, 4}) {
        const double of_silhouette = mean_squared_distance(silhouette, aspect, sigma, returns),
                     of_rear = mean_squared_distance(rear, aspect, sigma, returns);
        EXPECT_GT(of_silhouette, 2.4) << aspect << " +- " << sigma << ", returns " << returns;
        EXPECT_LT(of_silhouette, 4.2) << aspect << " +- " << sigma << ", returns " << returns;
        // The distance from the rear has the heading's error to first order: end-on, the silhouette only gets nearer.
        EXPECT_GT(of_rear, 2.4) << aspect << " +- " << sigma << ", returns " << returns;
        EXPECT_LT(of_rear, 5.2) << aspect << " +- " << sigma << ", returns " << returns;
      }
}

TEST(Returns, SpreadAsOverTheBoxWhereTheHeadingIsExact) {
  const auto estimator = estimators::make_estimator({});
  for (const double heading : {0.0, 0.05, 0.8}) {
    const SeenBox box = seen_car(30.0, 2.0, heading, 8.0, 0.2);
    Body body;
    body.extent.size = box.box.size;
    body.heading = {{heading, 0.0, true}, box.turn_rate};
    linear::Gaussian<4> state;
    state.x << box.centre, box.velocity;
    state.p = 0.01 * linear::Matrix<4>::Identity();
    body.estimate = state;
    EXPECT_TRUE(spread_of(body, *estimator, {}).isApprox(spread_of(box), 1e-9)) << heading;
  }
}

TEST(Returns, AMeanOfManyHasLess) {
  sensors::Observation one = radar(40.0, 0.1, 3.0, 0.1, 0.003, 0.05);
  one.seen = sensors::SeenPoint::kSilhouette;
  const Extent extent{config::Sizes{}};
  EXPECT_EQ(with_spread(one, extent).r, one.r) << "it has all of its uncertainty";
  one.returns = 1;
  sensors::Observation four = one;
  four.returns = 4;
  const linear::Matrix<3> added = with_spread(one, extent).r - one.r;
  EXPECT_GT(added(0, 0), 0.1);
  EXPECT_TRUE((with_spread(four, extent).r - four.r).isApprox(0.25 * added, 1e-12));
}

TEST(Spreads, AreComputedOnceForABodyAndASensor) {
  const auto estimator = estimators::make_estimator({});
  Body body;
  estimators::State x = estimators::State::Zero();
  x << 20.0, 6.0, 5.0, -1.0, 0.0, 0.0;
  body.estimate = estimate_of(config::MotionModel::kConstantVelocity, x, 0.1 * estimators::Covariance::Identity());
  body.heading = {{0.4, 0.01, true}};
  const sensors::Mounting front{{3.5, 0.0}}, corner{{3.5, 0.9}, 0.5};
  Spreads spreads(2);
  spreads.begin();
  const linear::Matrix<3> before = spreads.of(1, body, *estimator, front);
  EXPECT_EQ(before, spread_of(body, *estimator, front));
  EXPECT_EQ(spreads.of(1, body, *estimator, corner), spread_of(body, *estimator, corner)) << "another sensor";
  (void)spreads.of(1, body, *estimator, front);
  body.extent.size(0) = 12.0;
  EXPECT_EQ(spreads.of(1, body, *estimator, front), before) << "of the same list";
  spreads.forget(1);
  EXPECT_EQ(spreads.of(1, body, *estimator, front), spread_of(body, *estimator, front));
  body.extent.size(0) = 4.0;
  spreads.begin();
  EXPECT_EQ(spreads.of(1, body, *estimator, front), spread_of(body, *estimator, front)) << "of the next list";
}

// A car drives off, and a radar alone measures one to four of its points. Its tracks are as certain as they say.
TEST(Returns, OfACarThatDrivesAheadMakeAConsistentTrack) {
  config::TrackerConfig config = config_of(config::MotionModel::kConstantVelocity, 1.0);
  config.sensors.resize(1);
  const auto estimator = estimators::make_estimator(config);
  constexpr int kCars = 60, kLists = 60;
  constexpr double kFast = 6.0, kLong = 4.4, kWide = 1.8;
  double squares = 0.0;
  int judged = 0;
  for (std::uint32_t drive = 0; drive < kCars; ++drive) {
    RandomStream noise({2, drive, Purpose::kTest, 0, 0});
    Tracker tracker(config, 4);
    TrackSet set(tracker.max_tracks());
    double x = 30.0, v = kFast;
    for (int k = 0; k < kLists; ++k) {
      const double q = std::sqrt(0.05) * noise.normal();
      x += 0.05 * v + 0.025 * q;
      v += q;
      const auto returns = static_cast<std::uint8_t>(noise.integer(1, 4));
      const double rear = x - 0.5 * kLong, half = std::atan2(0.5 * kWide, rear);
      linear::Vector<3> mean = linear::Vector<3>::Zero();
      for (int i = 0; i < returns; ++i) {
        const double azimuth = noise.uniform(-half, half);
        mean += linear::Vector<3>(rear / std::cos(azimuth) + 0.15 * noise.normal(), azimuth + 0.003 * noise.normal(),
                                  v * std::cos(azimuth) + 0.05 * noise.normal()) /
                returns;
      }
      const double root = std::sqrt(returns);
      sensors::Observation z = radar(mean(0), mean(1), mean(2), 0.15 / root, 0.003 / root, 0.05 / root);
      z.seen = sensors::SeenPoint::kSilhouette;
      z.returns = returns;
      const std::vector<sensors::Observation> list{z};
      tracker.step(set, {{SensorId{0}, static_cast<std::uint32_t>(k)}, at_ms(50 * k), list});
    }
    if (set.tracks.size() != 1) continue;
    const TrackView view = shown(set.tracks[0], set.time, set.time, config);
    const linear::Vector<2> off(view.state(2) - v, view.state(3));
    squares += off.dot(view.covariance.block<2, 2>(2, 2).inverse() * off);
    ++judged;
  }
  EXPECT_GE(judged, kCars - 4);
  // Chi-square of 2 degrees each, below 2.6 with 0.99 for 60. The velocity across is judged with care, by a silhouette.
  EXPECT_GT(squares / judged, 0.3);
  EXPECT_LT(squares / judged, 2.6);
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
