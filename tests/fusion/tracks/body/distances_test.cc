// The reach of tracks against the distances of all points that may be seen.
#include "fusion/tracks/body/distances.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "fusion/tracks/body/turn.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

// A car at a drawn place, with a heading as uncertain as `sigma_heading`.
Track drawn(RandomStream& stream, double sigma_heading, SeenPoint anchored, const sensors::Mounting& mounting) {
  Track track;
  const double range = 3.0 + 80.0 * stream.uniform(), bearing = kPi * (2.0 * stream.uniform() - 1.0);
  estimators::State x = estimators::State::Zero();
  x << range * std::cos(bearing), range * std::sin(bearing), 5.0 * stream.normal(), 5.0 * stream.normal(), 0.0, 0.0;
  estimators::Covariance p = estimators::Covariance::Zero();
  p.diagonal() << 0.1, 0.1, 1.0, 1.0, 0.0, 0.0;
  track.estimate = estimate_of(config::MotionModel::kConstantVelocity, x, p);
  track.extent.size << 3.0 + 3.0 * stream.uniform(), 1.4 + 0.8 * stream.uniform();
  const double along = 0.5 * stream.uniform(), across = 0.2 * stream.uniform(), both = 0.7 * along * across;
  track.extent.covariance << along * along, both, both, across * across;
  track.heading.known = true;
  track.heading.value = kPi * (2.0 * stream.uniform() - 1.0);
  track.heading.variance = sigma_heading * sigma_heading;
  track.anchor = anchor_of(anchored, x.head<2>(), track.heading.value, mounting.position);
  return track;
}

TEST(Reach, ContainsEveryPointOfACarWithASureHeading) {
  constexpr double kGate = 11.8;
  const auto estimator = estimators::make_estimator({});
  RandomStream stream({.seed = 1, .purpose = Purpose::kTest, .entity = 0, .index = 0});
  constexpr SeenPoint kPoints[] = {SeenPoint::kCentre, SeenPoint::kEnd, SeenPoint::kSide, SeenPoint::kCorner,
                                   SeenPoint::kSilhouette};
  double narrowest = 1e9;
  for (int draw = 0; draw < 2000; ++draw)
    for (const SeenPoint anchored : kPoints) {
      const sensors::Mounting mounting{{draw % 2 == 0 ? 0.0 : 3.5, 0.0}, 0.0};
      const Track track = drawn(stream, kSureHeading * stream.uniform(), anchored, mounting);
      const linear::Vector<2> at = estimator->position(track.estimate).x;
      const double reach = reach_of(track, at, mounting, kGate);
      narrowest = std::min(narrowest, reach / track.extent.size.norm());
      for (const SeenPoint point : kPoints) {
        sensors::Observation z = position(at.x() + stream.normal(), at.y() + stream.normal(), 0.1);
        z.seen = point;
        const auto distance = distance_to(track, *estimator, z, mounting);
        if (!distance) continue;
        const linear::Vector<2> variance = (distance->constant + distance->noise).diagonal();
        for (Eigen::Index k = 0; k < 2; ++k)
          EXPECT_LE(std::abs(distance->between(k)) + std::sqrt(kGate * variance(k)), reach) << draw << ", axis " << k;
      }
    }
  EXPECT_LT(narrowest, 1.2) << "as far as the diagonal, and little more";
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
