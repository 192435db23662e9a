// Near places against all places.
#include "fusion/association/near_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/random.h"

namespace ttf::fusion::association {
namespace {

TrackPlace drawn(RandomStream& stream, std::size_t track) {
  // Coordinates of a grid, so that many are equal.
  return {std::round(stream.normal() * 40.0),
          std::round(stream.normal() * 40.0),
          0.1 + stream.uniform(),
          0.1 + stream.uniform(),
          track % 3 == 0 ? 4.0 : 0.0,
          track};
}

bool in_gate(const TrackPlace& a, const TrackPlace& b, double gate) {
  const double dx = std::max(0.0, std::abs(a.x - b.x) - b.reach), dy = std::max(0.0, std::abs(a.y - b.y) - b.reach);
  return dx * dx <= gate * (a.variance_x + b.variance_x) && dy * dy <= gate * (a.variance_y + b.variance_y);
}

constexpr double kGate = 11.8, kLargestVariance = 1.1;

// Holds the searches of 50 observations to all places. Returns how many places were tried in each on the average.
double try_some(NearPlaces& places, const std::vector<TrackPlace>& all, RandomStream& stream,
                const TrackPlace& about = {}) {
  constexpr int kSearches = 50;
  places.begin(kGate);
  for (const TrackPlace& place : all) places.add(place);
  places.arrange(kLargestVariance, kLargestVariance);
  EXPECT_EQ(places.all().size(), all.size());
  int tried = 0;
  for (int search = 0; search < kSearches; ++search) {
    TrackPlace at = drawn(stream, 1);
    at.x += about.x;
    at.y += about.y;
    std::vector<int> times(all.size());
    places.near(at, [&](const TrackPlace& place) {
      EXPECT_EQ(place.x, all[place.track].x);
      ++times[place.track];
      ++tried;
    });
    for (std::size_t track = 0; track < all.size(); ++track) {
      EXPECT_LE(times[track], 1);
      if (!in_gate(at, all[track], kGate)) continue;
      EXPECT_EQ(times[track], 1) << track << " of " << all.size();
    }
  }
  return static_cast<double>(tried) / kSearches;
}

std::vector<TrackPlace> all_drawn(RandomStream& stream, std::size_t count) {
  std::vector<TrackPlace> all;
  for (std::size_t track = 0; track < count; ++track) all.push_back(drawn(stream, track));
  return all;
}

RandomStream stream_of(std::uint64_t seed) {
  return RandomStream({.seed = seed, .purpose = Purpose::kTest, .entity = 0, .index = 0});
}

TEST(NearPlaces, AreAllInsideTheGateEachOnce) {
  constexpr std::size_t kMost = 1000;
  NearPlaces places(kMost);
  for (const std::size_t count : {0u, 1u, 2u, 16u, 17u, 17u, 300u, 1000u, 7u}) {
    RandomStream stream = stream_of(count);
    const double tried = try_some(places, all_drawn(stream, count), stream);
    EXPECT_LE(tried, static_cast<double>(count) / 10.0) << "far places are passed over";
  }
}

// All in one cell; one of them far away; all of them far away, and so far that cells have no numbers any more.
TEST(NearPlaces, MayBeAnywhere) {
  constexpr std::size_t kCount = 100;
  NearPlaces places(kCount);
  RandomStream stream = stream_of(1);
  std::vector<TrackPlace> all;
  for (std::size_t track = 0; track < kCount; ++track) all.push_back({.reach = 60.0, .track = track});
  EXPECT_GT(try_some(places, all, stream), 10.0);
  all = all_drawn(stream, kCount);
  all[7].x = -1e5;
  all[8].y = 1e300;
  try_some(places, all, stream);
  for (const TrackPlace& about : {TrackPlace{.x = -7e4, .y = 3e5}, TrackPlace{.x = 1e12, .y = -1e12}}) {
    for (TrackPlace& place : all) {
      place.x += about.x;
      place.y += about.y;
    }
    try_some(places, all, stream, about);
    all = all_drawn(stream, kCount);
  }
}

// One uncertain place lies in no cell; many are the common ones. Without any uncertainty, cells are as small as can be.
TEST(NearPlaces, MayBeUncertain) {
  constexpr std::size_t kCount = 100;
  NearPlaces places(kCount);
  RandomStream stream = stream_of(2);
  std::vector<TrackPlace> all = all_drawn(stream, kCount);
  all[3].variance_x = 1e4;
  try_some(places, all, stream);
  for (std::size_t track = 40; track < 80; ++track) all[track].variance_y = 1e4;
  try_some(places, all, stream);
  for (TrackPlace& place : all) place.variance_x = place.variance_y = place.reach = 0.0;
  try_some(places, all, stream);
}

}  // namespace
}  // namespace ttf::fusion::association
