// An observation of another point of the object, referred to the one that its track follows.
#include "fusion/tracks/body/distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/tracks/body/returns.h"
#include "tests/fusion/tracks/body/drawn_outline.h"

namespace ttf::fusion::tracks::body {
namespace {

using V = linear::Vector<2>;

// A radar's centre, referred to the rear: with range rate, of an object beside the radar.
TEST(MovedRadar, TakesTheRangeRateAlong) {
  Body body;
  linear::Gaussian<4> state;
  state.x << 10.0, 2.0, 8.0, -3.0;
  state.p = 0.01 * linear::Matrix<4>::Identity();
  body.estimate = state;
  body.anchor = {sensors::SeenPoint::kEnd, -1, 0};
  const double heading = std::atan2(-3.0, 8.0);
  body.heading = {{heading, 1e-20, true}};
  body.extent.covariance.setZero();
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
    body.extent.size(0) = length;
    const sensors::Observation centre = radar(rear + 0.5 * length * velocity.normalized());
    const std::optional<Distance> distance = distance_to(body, *estimator, centre, {});
    ASSERT_TRUE(distance);
    const sensors::Observation moved = counted(centre, *distance, {}, linear::Matrix<2>::Zero());
    // To first order in the lever.
    EXPECT_NEAR((moved.z - radar(rear).z).norm(), 0.0, 0.05 * length * length);
    EXPECT_NEAR(moved.z(2), radar(rear).z(2), 0.02 * length * length);
  }
  sensors::Observation nowhere = radar(rear);
  nowhere.z(0) = 0.0;
  const std::optional<Distance> distance = distance_to(body, *estimator, nowhere, {});
  ASSERT_TRUE(distance);
  EXPECT_TRUE(counted(nowhere, *distance, {}, linear::Matrix<2>::Identity()).z.allFinite());
  EXPECT_TRUE(expected(nowhere, *distance, {}).r.allFinite());
}

// A turning car is tracked by its rear, and a radar sees its silhouette. Near end-on the hidden side comes into view, and the
// silhouette runs along the outline by metres a radian. Returns come from matter: drawn ones have the velocity of their points,
// under turn rates as uncertain as the track's. The spread of the returns takes the turn rate as known, which leaves out up to
// a sixth of the variance here.
TEST(MovedRadar, ExpectsTheRangeRateOfMatterAsAHiddenSideComesIntoView) {
  constexpr int kDraws = 4'000;
  constexpr double kFast = 8.0, kRate = 0.3, kRateSigma = 0.1, kNoise = 0.05;  // [m/s], [rad/s], [m/s]
  const auto estimator = estimators::make_estimator({});
  const V rear(20.0, 0.0);
  for (const double aspect : {0.0, 0.05, 0.1, 0.2})
    for (const int returns : {1, 16}) {
      Body body;
      body.anchor = {sensors::SeenPoint::kEnd, -1, 0};
      body.extent.covariance.setZero();
      body.heading = {{aspect, 1e-12, true}, kRate, kRateSigma * kRateSigma};
      const Box box{body.extent.size, aspect};
      const V along(std::cos(aspect), std::sin(aspect)), left(-along.y(), along.x());
      const double behind = 0.5 * box.size(0);
      const V velocity = kFast * along - kRate * behind * left;  // the rear's, of a centre that moves straight ahead
      linear::Gaussian<4> state;
      state.x << rear, velocity;
      state.p = 1e-8 * linear::Matrix<4>::Identity();
      body.estimate = state;
      const DrawnOutline outline(rear + behind * along, box);
      RandomStream stream({5, 0, Purpose::kTest, 0, 0});
      double sum = 0.0, squares = 0.0, stated = 0.0;
      for (int k = 0; k < kDraws; ++k) {
        const double rate = kRate + kRateSigma * stream.normal();
        sensors::Observation z;
        z.kind = sensors::ObservationKind::kRangeBearingRate;
        z.seen = sensors::SeenPoint::kSilhouette;
        z.returns = static_cast<std::uint8_t>(returns);
        z.r.diagonal() << 0.01, 1e-5, kNoise * kNoise / returns;
        for (int i = 0; i < returns; ++i) {
          const V at = outline.draw(stream);
          const double seen = range_rate_of(at, rear, velocity, rate) + kNoise * stream.normal();
          z.z += linear::Vector<3>(at(0), at(1), seen) / returns;
        }
        const sensors::Observation spread = with_spread(z, body, *estimator, {});
        const std::optional<Distance> distance = distance_to(body, *estimator, spread, {});
        ASSERT_TRUE(distance);
        const sensors::Observation of_rear = expected(spread, *distance, {});
        const double off = of_rear.z(2) - rear.normalized().dot(velocity);
        sum += off / kDraws;
        squares += off * off / kDraws;
        stated += of_rear.r(2, 2) / kDraws;
      }
      EXPECT_NEAR(sum, 0.0, 0.03) << "aspect " << aspect << ", returns " << returns;
      const double ratio = (squares - sum * sum) / stated;
      EXPECT_GT(ratio, 0.85) << "aspect " << aspect << ", returns " << returns;
      EXPECT_LT(ratio, 1.25) << "aspect " << aspect << ", returns " << returns;
    }
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
