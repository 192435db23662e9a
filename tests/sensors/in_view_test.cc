// The objects in view of sensors: by hand, by many rays, and by the lists of the models.
#include "sensors/in_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/random.h"
#include "recording/scene/geometry.h"
#include "sensors/laser/kind.h"
#include "sensors/mono_camera/kind.h"
#include "sensors/stereo_camera/kind.h"
#include "tests/sensors/car_at.h"

namespace ttf::sensors {
namespace {

using Objects = std::vector<ObjectState>;
using fusion::sensors::Field;

std::vector<bool> in_view(const std::vector<SensorView>& sensors, const Objects& objects) {
  InView view(sensors, objects.size());
  const std::span<const char> found = view.of(objects);
  return {found.begin(), found.end()};
}
SensorView ahead(double half_angle, double max_range, double shadow = Field::kUnbounded) {
  return {{}, {.half_angle = half_angle, .max_range = max_range, .shadow = shadow}};
}

// Cars are 4.4 m by 1.8 m. The rear of the near one, 17.8 m ahead, hides azimuths up to atan(0.9 / 17.8). The rear left corner
// of the far one at (37.8, y + 0.9) comes out of that at y = 37.8 * 0.9 / 17.8 - 0.9 = 1.011.
TEST(InView, APartBesideANearerObjectIsEnough) {
  for (const double side : {-1.0, 1.0}) {
    const auto far_seen = [&](double y) {
      return in_view({ahead(1.0, 100.0)}, {car_at(0, 40.0, side * y), car_at(1, 20.0, 0.0)});
    };
    EXPECT_EQ(far_seen(1.00), (std::vector{false, true}));
    EXPECT_EQ(far_seen(1.02), (std::vector{true, true}));
  }
}

// The front right corner of a car at (20, y) is at (22.2, y - 0.9): in a half angle of 0.5 up to y = 22.2 tan 0.5 + 0.9 = 13.028.
TEST(InView, APartInTheFieldIsEnough) {
  for (const double y : {13.0, -13.0}) EXPECT_TRUE(in_view({ahead(0.5, 100.0)}, {car_at(0, 20.0, y)})[0]);
  for (const double y : {13.05, -13.05}) EXPECT_FALSE(in_view({ahead(0.5, 100.0)}, {car_at(0, 20.0, y)})[0]);
  EXPECT_FALSE(in_view({ahead(0.5, 100.0)}, {car_at(0, -20.0, 0.0)})[0]);
}

// The rear is 2.2 m before the centre.
TEST(InView, TheNearestPartIsInTheRange) {
  for (const double shadow : {0.0, 0.5, Field::kUnbounded}) {
    EXPECT_TRUE(in_view({ahead(0.5, 100.0, shadow)}, {car_at(0, 102.1, 0.0)})[0]);
    EXPECT_FALSE(in_view({ahead(0.5, 100.0, shadow)}, {car_at(0, 102.3, 0.0)})[0]);
    // Aside, its near corner (99.8, 6.1) is in the range of 100 m; the middle of its silhouette is not.
    EXPECT_TRUE(in_view({ahead(0.5, 100.0, shadow)}, {car_at(0, 102.0, 7.0)})[0]);
    EXPECT_FALSE(in_view({ahead(0.5, 100.0, shadow)}, {car_at(0, 102.1, 7.0)})[0]);
    // The middle of a wall 28.5 m ahead is nearer than 30 m, its ends are not.
    SensorView blind_near = ahead(0.8, 100.0, shadow);
    blind_near.field.min_range = 30.0;
    ObjectState wall = car_at(0, 29.0, 0.0);
    wall.length = 1.0;
    wall.width = 30.0;
    EXPECT_TRUE(in_view({blind_near}, {wall})[0]);
    wall.width = 10.0;
    EXPECT_FALSE(in_view({blind_near}, {wall})[0]);
  }
  SensorView far = ahead(0.5, 100.0);
  far.field.min_range = 30.0;
  EXPECT_EQ(in_view({far}, {car_at(0, 20.0, 0.0), car_at(1, 40.0, 3.0)}), (std::vector{false, true}));
}

// The near rear is 17.8 m ahead: a shadow of 0.5 ends at 26.7 m.
TEST(InView, AFiniteShadowEnds) {
  for (const double rear : {26.0, 27.0}) {
    const Objects objects{car_at(0, 20.0, 0.0), car_at(1, rear + 2.2, 0.0)};
    EXPECT_EQ(in_view({ahead(1.0, 100.0, 0.5)}, objects), (std::vector{true, rear > 26.7}));
    EXPECT_EQ(in_view({ahead(1.0, 100.0, 0.0)}, objects), (std::vector{true, true}));
    EXPECT_EQ(in_view({ahead(1.0, 100.0)}, objects), (std::vector{true, false}));
  }
}

TEST(InView, BlindSectorsAreNoView) {
  for (const double shadow : {0.0, Field::kUnbounded}) {
    SensorView sensor = ahead(1.0, 100.0, shadow);
    sensor.field.blind_sectors = 1;
    sensor.field.blind[0] = {-0.1, 0.1};
    // All of it is within 0.9 / 17.8 = 0.05 rad; moved by 2 m, its left end is at 2.9 / 17.8 = 0.16 rad.
    EXPECT_FALSE(in_view({sensor}, {car_at(0, 20.0, 0.0)})[0]);
    EXPECT_TRUE(in_view({sensor}, {car_at(0, 20.0, 2.0)})[0]);
  }
}

// A sensor at the rear looks back; one that is switched off reaches nothing.
TEST(InView, AnObjectIsInViewOfOneSensorOrAnother) {
  SensorView rear = ahead(0.5, 50.0), off = ahead(0.5, 0.0);
  rear.placement = {-1.0, 0.0, std::numbers::pi};
  const Objects objects{car_at(0, 30.0, 0.0), car_at(1, -30.0, 0.0), car_at(2, 0.0, 10.0)};
  EXPECT_EQ(in_view({ahead(0.5, 50.0)}, objects), (std::vector{true, false, false}));
  EXPECT_EQ(in_view({rear}, objects), (std::vector{false, true, false}));
  EXPECT_EQ(in_view({ahead(0.5, 50.0), rear}, objects), (std::vector{true, true, false}));
  EXPECT_EQ(in_view({off}, objects), (std::vector{false, false, false}));
}

TEST(InView, AnOutlineAboutTheSensorNeitherHidesNorIsSeen) {
  EXPECT_EQ(in_view({ahead(1.0, 100.0)}, {car_at(0, 0.5, 0.0), car_at(1, 30.0, 0.0)}), (std::vector{false, true}));
}

// Cars, people and trucks about the sensor, none over another or over the sensor.
Objects drawn_scene(std::uint64_t seed) {
  RandomStream draw({.seed = seed, .purpose = Purpose::kTest, .entity = 22});
  Objects objects;
  const int count = static_cast<int>(draw.integer(2, 40));
  const double farthest = draw.uniform(15.0, 90.0);
  for (int i = 0; i < count; ++i) {
    ObjectState state;
    state.id = ObjectId{static_cast<std::uint16_t>(objects.size())};
    const double distance = farthest * std::sqrt(draw.uniform()), bearing = draw.uniform(-3.1, 3.1);
    state.x = distance * std::cos(bearing);
    state.y = distance * std::sin(bearing);
    state.heading = draw.uniform(-std::numbers::pi, std::numbers::pi);
    state.length = draw.uniform(0.4, 12.0);
    state.width = draw.uniform(0.4, 2.5);
    const auto outline = [](const ObjectState& one) {
      return recording::scene::rectangle({one.x, one.y, one.heading}, one.length, one.width);
    };
    bool free = std::hypot(state.x, state.y) > 0.5 * (state.length + state.width);
    for (const ObjectState& other : objects) free = free && !recording::scene::overlap(outline(state), outline(other));
    if (free) objects.push_back(state);
  }
  return objects;
}

TEST(InView, AllObjectsAreInAnUnboundedFieldThatNothingHides) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Objects objects = drawn_scene(seed);
    EXPECT_EQ(in_view({ahead(Field::kUnbounded, Field::kUnbounded, 0.0)}, objects), std::vector(objects.size(), true));
  }
}

// Returns whether one of many rays from `low` to `high` meets the object first, within the range.
bool met_first(const Objects& objects, std::size_t object, double low, double high, double max_range) {
  constexpr int kRays = 4'000;
  const RayTarget target(objects[object]);
  for (int k = 0; k < kRays; ++k) {
    const double azimuth = low + (k + 0.5) / kRays * (high - low);
    const auto range = target.ray_to(azimuth);
    if (!range || *range > max_range) continue;
    bool hidden = false;
    for (std::size_t i = 0; i < objects.size() && !hidden; ++i)
      if (const auto other = i == object ? std::nullopt : RayTarget(objects[i]).ray_to(azimuth))
        hidden = *other < *range;
    if (!hidden) return true;
  }
  return false;
}

TEST(InView, IsThatOfManyRays) {
  int seen = 0, unseen = 0, narrow = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Objects objects = drawn_scene(seed);
    const double half = 1.0, max_range = 60.0;
    const std::vector<bool> found = in_view({ahead(half, max_range)}, objects);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const bool expected = met_first(objects, i, -half, half, max_range);
      EXPECT_TRUE(found[i] || !expected) << "seed " << seed << ", object " << i;
      if (!expected && found[i]) ++narrow;  // a sector between two rays
      ++(expected ? seen : unseen);
    }
  }
  EXPECT_GT(seen, 200);
  EXPECT_GT(unseen, 200);
  EXPECT_LE(narrow, seen / 100);
}

// A model lists nothing that is out of view.
template <class Kind, class Listed> void expect_listed_in_view(const Listed& listed) {
  const typename Kind::Model model{};
  int objects_listed = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Objects objects = drawn_scene(seed);
    const std::vector<bool> found = in_view({{model.device.placement, *Kind::field_of(model)}}, objects);
    for (const ObjectId id : listed(model, objects, seed)) {
      if (id == ObjectId{0xffff}) continue;
      ++objects_listed;
      EXPECT_TRUE(found[index_of(id)]) << "seed " << seed << ", object " << index_of(id);
    }
  }
  EXPECT_GT(objects_listed, 300);
}

TEST(InView, HasWhatALaserLists) {
  expect_listed_in_view<laser::Kind>([](const laser::LaserConfig& model, const Objects& objects, std::uint64_t seed) {
    std::vector<laser::HitPoint> hits;
    std::vector<ObjectId> truth;
    measure_laser(model, objects, {.seed = seed}, hits, truth);
    return truth;
  });
}

TEST(InView, HasWhatAStereoCameraLists) {
  using stereo_camera::CameraConfig;
  expect_listed_in_view<stereo_camera::Kind>([](const CameraConfig& model, const Objects& objects, std::uint64_t seed) {
    stereo_camera::CameraRoom room(objects.size());
    std::vector<stereo_camera::CameraDetection> detections;
    std::vector<ObjectId> truth;
    measure_camera(model, objects, {.seed = seed}, room, detections, truth);
    return truth;
  });
}

TEST(InView, HasWhatAMonoCameraLists) {
  using mono_camera::MonoCameraConfig;
  expect_listed_in_view<mono_camera::Kind>(
      [](const MonoCameraConfig& model, const Objects& objects, std::uint64_t seed) {
        mono_camera::MonoCameraRoom room(objects.size());
        std::vector<mono_camera::MonoBox> boxes;
        std::vector<ObjectId> truth;
        measure_mono_camera(model, objects, {.seed = seed}, room, boxes, truth);
        return truth;
      });
}

}  // namespace
}  // namespace ttf::sensors
