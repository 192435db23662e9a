// A crowd, tracked as a whole.
#include "fusion/tracks/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

TEST(Tracker, Follows25ObjectsEachWithItsOwnTrack) {
  Bench bench;
  Lanes lanes{.miss_probability = 0.1};
  std::vector<std::optional<ObservationId>> track_of(25);
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < 100; ++k) {
    const GlobalTime t = at_ms(40 * k);
    bench.step(40 * k, lanes.see(t, static_cast<std::uint32_t>(k)));
    if (k < 15) continue;
    ASSERT_EQ(confirmed(bench.set), 25) << "list " << k;
    for (int object = 0; object < 25; ++object) {
      const estimators::State truth = lanes.truth(object, t);
      const auto nearest =
          std::min_element(bench.set.tracks.begin(), bench.set.tracks.end(), [&](const Track& a, const Track& b) {
            return (state_of(a) - truth).head<2>().squaredNorm() < (state_of(b) - truth).head<2>().squaredNorm();
          });
      const double squared = (state_of(*nearest) - truth).head<2>().squaredNorm();
      ASSERT_LT(squared, 1.0);
      squares += squared;
      ++count;
      std::optional<ObservationId>& birth = track_of[static_cast<std::size_t>(object)];
      if (!birth) birth = nearest->birth;
      ASSERT_TRUE(birth == nearest->birth) << "object " << object << " changed its track";
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.2) << "better than one measurement's 0.28 m in the plane";
}

}  // namespace
}  // namespace ttf::fusion::tracks
