// Objects that hide others, against the plain way of trying all pairs.
#include "sensors/occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "sensors/shape.h"

namespace ttf::sensors {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

std::vector<char> tried_pair_by_pair(const std::vector<ObjectState>& objects, const std::vector<Sight>& sights,
                                     double shadow) {
  std::vector<char> hidden(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const ObjectState& other : objects)
      if (sights[i].wanted && other.id != objects[i].id && hides(other, sights[i].bearing, sights[i].range, shadow))
        hidden[i] = 1;
  return hidden;
}

// The sight of the middle of the silhouette, at a point of the outline.
Sight sight_of(const ObjectState& state) {
  const auto span = azimuth_span(state);
  if (!span) return {};
  Sight sight{0.5 * (span->low + span->high), 0.0, 0.5 * (span->high - span->low), true};
  const auto range = RayTarget(state).ray_to(sight.bearing);
  sight.range = range.value_or(0.0);
  sight.wanted = range && std::abs(sight.bearing) <= 1.2;
  return sight;
}

struct Crowd {
  std::vector<ObjectState> objects;
  std::vector<Sight> sights;
};
// Objects all around the sensor, at any distance and of any size, some of them over each other or over the sensor.
Crowd drawn_scene(std::uint64_t seed, int count) {
  RandomStream draw({.seed = seed, .purpose = Purpose::kTest, .entity = 21});
  Crowd scene;
  const double farthest = draw.uniform(5.0, 200.0), largest = draw.uniform(0.2, 20.0);
  for (int i = 0; i < count; ++i) {
    ObjectState state;
    state.id = ObjectId{static_cast<std::uint16_t>(i)};
    const double distance = farthest * std::sqrt(draw.uniform()),
                 bearing = draw.uniform(-1.5, 1.5) * (i % 7 ? 1.0 : 2.0);
    state.x = distance * std::cos(bearing);
    state.y = i % 5 ? distance * std::sin(bearing) : 0.0;  // some on one line
    state.heading = i % 3 ? draw.uniform(-std::numbers::pi, std::numbers::pi) : 0.0;
    state.length = draw.uniform(0.1, largest);
    state.width = draw.uniform(0.1, 0.5 * largest);
    scene.objects.push_back(state);
    scene.sights.push_back(sight_of(state));
  }
  return scene;
}

TEST(Occlusion, IsThatOfThePlainWay) {
  int hidden = 0, seen = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const int count = static_cast<int>(seed % 80);
    const Crowd scene = drawn_scene(seed, count);
    Occlusion occlusion(static_cast<std::size_t>(count) + seed % 3);
    for (const double shadow : {kNoEnd, 0.0, 0.02, 0.5}) {
      const auto expected = tried_pair_by_pair(scene.objects, scene.sights, shadow);
      const auto found = occlusion.hidden(scene.objects, scene.sights, shadow);
      ASSERT_EQ(std::vector(found.begin(), found.end()), expected) << "seed " << seed << ", shadow " << shadow;
      for (std::size_t i = 0; i < expected.size(); ++i) (expected[i] ? hidden : seen) += scene.sights[i].wanted;
    }
  }
  EXPECT_GT(hidden, 5'000);
  EXPECT_GT(seen, 5'000);
}

// A square full of people: of a million pairs, a few for each person.
TEST(Occlusion, OfACrowdTriesFewPairs) {
  Crowd scene;
  for (int row = 0; row < 25; ++row)
    for (int i = -20; i < 20; ++i) {
      ObjectState state;
      state.id = ObjectId{static_cast<std::uint16_t>(scene.objects.size())};
      state.x = 40.0 + 6.0 * row;
      state.y = 2.0 * i + 0.3 * row;
      state.length = state.width = 0.5;
      scene.objects.push_back(state);
      scene.sights.push_back(sight_of(state));
    }
  Occlusion occlusion(scene.objects.size());
  for (const double shadow : {kNoEnd, 0.0224}) {
    const auto found = occlusion.hidden(scene.objects, scene.sights, shadow);
    EXPECT_LT(occlusion.tried(), 3 * scene.objects.size()) << shadow;
    EXPECT_EQ(std::vector(found.begin(), found.end()), tried_pair_by_pair(scene.objects, scene.sights, shadow));
  }
}

}  // namespace
}  // namespace ttf::sensors
