// The gate against all pairs, tried one by one.
#include "fusion/tracks/parts/gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "fusion/association/assignment.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/tracks/parts/polar_gate.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

// The observation of each track when every pair is tried: the plain way.
std::vector<int> tried_pair_by_pair(const Tracker& tracker, const TrackSet& set, const sensors::ObservationList& list,
                                    double gate) {
  std::vector<association::Candidate> candidates;
  for (std::size_t o = 0; o < list.observations.size(); ++o)
    for (std::size_t t = 0; t < set.tracks.size(); ++t) {
      const auto apart = tracker.estimator().distance_squared(set.tracks[t].estimate, list.observations[o]);
      if (apart && *apart <= gate)
        candidates.push_back(
            {static_cast<int>(o), static_cast<int>(t), gate - *apart + 1e-9 + (set.tracks[t].confirmed ? 100.0 : 0.0)});
    }
  association::Assignment assignment(list.observations.size(), set.tracks.size());
  assignment.solve(candidates, list.observations.size(), set.tracks.size());
  std::vector<int> observation_of(set.tracks.size(), -1);
  for (std::size_t o = 0; o < list.observations.size(); ++o)
    if (const int t = assignment.column_of()[o]; t >= 0)
      observation_of[static_cast<std::size_t>(t)] = static_cast<int>(o);
  return observation_of;
}

// Crowds on lanes or in a heap, with misses and clutter. Large ones are searched in strips.
TEST(Gate, AssignsAsThePlainWayDoes) {
  int assigned = 0;
  for (const int objects : {10, 60, 65, 150, 300}) {
    config::TrackerConfig config;
    config.max_objects = objects;
    const double gate = metrics::chi_square_quantile(config.gate_probability, 2);
    Tracker tracker(config, static_cast<std::size_t>(2 * objects));
    TrackSet set(tracker.max_tracks()), now(tracker.max_tracks());
    const Lanes lanes{.objects = objects, .across = 10, .sigma = 0.3, .miss_probability = 0.2, .seed = 5};
    RandomStream draw({.seed = 6, .purpose = Purpose::kTest, .entity = 13});
    for (std::uint32_t k = 0; k < 12; ++k) {
      std::vector<sensors::Observation> seen = lanes.see(at_ms(40 * k), k);
      for (sensors::Observation& z : seen)
        if (objects == 150) z.z(0) = 20.0 + 0.05 * (z.z(0) - 20.0);  // a heap
      for (int i = 0; i < objects / 2; ++i)
        seen.push_back(position(draw.uniform(0.0, 400.0), draw.uniform(-80.0, 80.0), draw.uniform(0.1, 3.0)));
      const OwnedList list = list_of(0, k, at_ms(40 * k), seen);
      now = set;
      now.tracks.reserve(tracker.max_tracks());
      for (Track& track : now.tracks) tracker.estimator().predict(track.estimate, 0.04);
      const auto expected = tried_pair_by_pair(tracker, now, list.view(), gate);
      const auto found = tracker.assigned(now, list.view());
      ASSERT_EQ(std::vector(found.begin(), found.end()), expected) << objects << " objects, list " << k;
      assigned += static_cast<int>(std::count_if(expected.begin(), expected.end(), [](int o) { return o >= 0; }));
      tracker.step(set, list.view());
    }
  }
  EXPECT_GT(assigned, 3'000);
}

TEST(Gate, GatesOutWhatIsTooFar) {
  Bench bench;
  for (int k = 0; k < 20; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.1)});
  bench.step(1000, {position(21.5, 0.0, 0.1)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  EXPECT_EQ(bench.set.tracks[0].misses, 1);
  EXPECT_NEAR(state_of(bench.set.tracks[0])(0), 20.0, 0.1);
}

// A car that a sensor sees at a drawn place, and that was seen by another one before.
Track drawn_track(RandomStream& stream) {
  Track track;
  const double range = 3.0 + 60.0 * stream.uniform(), bearing = 2.4 * stream.uniform() - 1.2;
  estimators::State x = estimators::State::Zero();
  x << range * std::cos(bearing), range * std::sin(bearing), 8.0 * stream.normal(), 8.0 * stream.normal(), 0.0, 0.0;
  estimators::Covariance p = estimators::Covariance::Zero();
  p.diagonal() << 0.01 + 2.0 * stream.uniform(), 0.01 + 2.0 * stream.uniform(), 1.0, 1.0, 0.0, 0.0;
  p(0, 1) = p(1, 0) = 0.9 * std::sqrt(p(0, 0) * p(1, 1)) * (2.0 * stream.uniform() - 1.0);
  track.estimate = estimate_of(config::MotionModel::kConstantVelocity, x, p);
  track.extent.size << 4.4, 1.8;
  track.extent.covariance << 0.2, 0.02, 0.02, 0.05;
  track.heading.known = stream.uniform() < 0.8;
  track.heading.value = kPi * (2.0 * stream.uniform() - 1.0);
  track.heading.variance = 0.1 * stream.uniform();
  track.anchor = body::anchor_of(stream.uniform() < 0.5 ? sensors::SeenPoint::kEnd : sensors::SeenPoint::kSilhouette,
                                 x.head<2>(), track.heading.value, {1.0, 0.5});
  return track;
}

// The filter would exclude the same pairs, too. Most pairs that are far off are among them.
TEST(PolarGate, ExcludesNoPairThatIsInTheGate) {
  const auto estimator = estimators::make_estimator({});
  const double gate = metrics::chi_square_quantile(0.9973, 3);
  RandomStream stream({4, 0, Purpose::kTest, 0, 0});
  int inside = 0, beyond = 0, far = 0;
  for (int draw = 0; draw < 20'000; ++draw) {
    const Track track = drawn_track(stream);
    const linear::Gaussian<2> at = estimator->position(track.estimate);
    sensors::Observation z;
    const sensors::Mounting from{{stream.normal(), stream.normal()}, stream.normal(), 0.0};
    const linear::Vector<2> off = at.x - from.position;
    const double scale = stream.uniform() < 0.5 ? 1.0 : 8.0;
    z = radar(std::abs(off.norm() + scale * stream.normal()),
              std::atan2(off.y(), off.x()) - from.yaw + scale * stream.normal() / off.norm(), 8.0 * stream.normal(),
              0.05 + 0.3 * stream.uniform(), 0.002 + 0.02 * stream.uniform(), 5.0);
    z.seen = sensors::SeenPoint::kSilhouette;
    z.returns = static_cast<std::uint8_t>(stream.integer(0, 3));
    z.from = from;
    const linear::Matrix<3> spread = body::spread_of(track, *estimator, from);
    const auto distance = body::distance_to(track, *estimator, z, from);
    sensors::Observation judged = body::with_spread(z, spread);
    if (distance) judged = body::expected(judged, *distance, from);
    const auto squared = estimator->distance_squared(track.estimate, judged);
    const double bearing = z.z(1) + from.yaw;
    const bool excluded =
        beyond_gate(z, {std::cos(bearing), std::sin(bearing)}, {at.x(0), at.x(1), at.p(0, 0), at.p(1, 1), 5.0, 0},
                    distance ? &*distance : nullptr, z.returns > 0 ? &spread : nullptr, gate);
    if (!squared) continue;
    inside += *squared <= gate ? 1 : 0;
    beyond += excluded ? 1 : 0;
    far += *squared > 4.0 * gate ? 1 : 0;
    ASSERT_FALSE(excluded && *squared <= gate) << draw << ": " << *squared;
  }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(beyond, far / 2);
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
