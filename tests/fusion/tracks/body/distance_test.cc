// An observation of another point of the object, referred to the one that its track follows.
#include "fusion/tracks/body/distance.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace ttf::fusion::tracks::body
