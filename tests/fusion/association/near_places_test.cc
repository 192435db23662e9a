// Near places against all places.
#include "fusion/association/near_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/random.h"

namespace ttf::fusion::association {
namespace {

Place drawn(RandomStream& stream, std::size_t track) {
  // Coordinates of a grid, so that many are equal.
  return {std::round(stream.normal() * 40.0),
          std::round(stream.normal() * 40.0),
          0.1 + stream.uniform(),
          0.1 + stream.uniform(),
          track % 3 == 0 ? 4.0 : 0.0,
          track};
}

bool in_gate(const Place& a, const Place& b, double gate) {
  const double dx = std::max(0.0, std::abs(a.x - b.x) - b.reach), dy = std::max(0.0, std::abs(a.y - b.y) - b.reach);
  return dx * dx <= gate * (a.variance_x + b.variance_x) && dy * dy <= gate * (a.variance_y + b.variance_y);
}

// One strip and several, the same places sorted once more, and others after them.
TEST(NearPlaces, AreAllInsideTheGateEachOnce) {
  constexpr std::size_t kMost = 1000;
  constexpr double kGate = 11.8;
  NearPlaces places(kMost);
  std::size_t tried = 0, searches = 0;
  for (const std::size_t count : {0u, 1u, 2u, 64u, 65u, 65u, 300u, 1000u, 7u}) {
    RandomStream stream({.seed = count, .purpose = Purpose::kTest, .entity = 0, .index = 0});
    std::vector<Place> all;
    places.clear();
    for (std::size_t track = 0; track < count; ++track) places.add(all.emplace_back(drawn(stream, track)));
    places.sort();
    EXPECT_EQ(places.all().size(), count);
    for (int search = 0; search < 50; ++search) {
      const Place at = drawn(stream, 1);
      std::vector<int> times(count);
      places.near(at, kGate, [&](const Place& place) {
        EXPECT_EQ(place.x, all[place.track].x);
        ++times[place.track];
        tried += count == kMost ? 1 : 0;
      });
      searches += count == kMost ? 1 : 0;
      for (std::size_t track = 0; track < count; ++track) {
        EXPECT_LE(times[track], 1);
        if (!in_gate(at, all[track], kGate)) continue;
        EXPECT_EQ(times[track], 1) << track << " of " << count;
      }
    }
  }
  EXPECT_LT(tried / searches, kMost / 10) << "far places are passed over";
}

}  // namespace
}  // namespace ttf::fusion::association
