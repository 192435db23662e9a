// The reach of tracks against the distances of all points that may be seen.
#include "fusion/tracks/distances.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "fusion/tracks/returns.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
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

// Radar observations near and far from cars; what is far off is outside the gate.
TEST(FarOff, IsOutsideTheGate) {
  constexpr double kGate = 16.3;
  const auto estimator = estimators::make_estimator({});
  RandomStream stream({.seed = 2, .purpose = Purpose::kTest, .entity = 0, .index = 0});
  int outside = 0, told = 0;
  for (int draw = 0; draw < 20'000; ++draw) {
    const sensors::Mounting mounting{{-0.9, 0.9}, 2.2};
    const SeenPoint anchored = draw % 2 == 0 ? SeenPoint::kCorner : SeenPoint::kSilhouette;
    const Track track = drawn(stream, 0.5 * stream.uniform(), anchored, mounting);
    const linear::Gaussian<2> at = estimator->position(track.estimate);
    const linear::Vector<2> sight = at.x - mounting.position;
    sensors::Observation z = radar(std::max(0.5, sight.norm() + 10.0 * stream.normal()),
                                   std::atan2(sight.y(), sight.x()) - mounting.yaw + 0.3 * stream.normal(),
                                   sight.normalized().dot(state_of(track).segment<2>(2)), 0.1, 0.008, 0.05);
    z.seen = SeenPoint::kSilhouette;
    z.from = mounting;
    z.returns = static_cast<std::uint8_t>(draw % 5);
    const association::Place place{at.x(0), at.x(1), at.p(0, 0), at.p(1, 1), reach_of(track, at.x, mounting, 11.8), 0};
    const bool far = far_off(z, place, track.extent, kGate);
    const sensors::Observation seen = with_spread(z, track, *estimator, mounting);
    const std::optional<Distance> distance = distance_to(track, *estimator, seen, mounting);
    const std::optional<double> squared =
        estimator->distance_squared(track.estimate, distance ? expected(seen, *distance, mounting) : seen);
    const bool is_outside = !squared || !(*squared <= kGate);
    EXPECT_TRUE(is_outside || !far) << draw;
    outside += is_outside;
    told += far;
  }
  EXPECT_GT(told, outside / 10);
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
}  // namespace ttf::fusion::tracks
