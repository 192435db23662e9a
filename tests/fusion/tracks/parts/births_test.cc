// Births of true objects in clutter. How soon are tracks confirmed of objects that two sensors see, or one? How many are
// confirmed of nothing? With and without knowledge of the fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

// A laser every 80 ms and a camera every 40 ms, as in the shipped clusters. Both see 60 m, the laser 60 degrees aside, the
// camera 26. Each drive has two objects in both fields and two in the laser's alone, all drawn, at constant velocity. Each
// is seen with probability 0.9 from the first list on. Each list has clutter of one density in its sensor's field, from the
// first list on, too.
constexpr double kFar = 60.0, kHalfAngle[] = {1.05, 0.45}, kSigma = 0.3, kSeen = 0.9;
constexpr std::int64_t kUntil = 2000;

struct Object {
  double x, y, vx, vy;
};

struct Born {
  double in_both = 0.0, in_one = 0.0;  // mean time to the first confirmed track within 3 m [s]; 2 s if there is none
  double unborn_in_both = 0.0, unborn_in_one = 0.0;  // share without a track after 1 s
  double false_tracks = 0.0;                         // confirmed ones per list
};

Born births(config::Birth birth, config::Association association, bool fields_known, double clutter, int drives) {
  config::TrackerConfig config;
  config.birth = birth;
  config.association = association;
  config.detection_probability = kSeen;
  config.clutter_density = std::max(clutter, 1e-5);
  config.sensors.resize(2);
  for (std::size_t s = 0; fields_known && s < 2; ++s)
    config.sensors[s].field = {.half_angle = kHalfAngle[s], .max_range = kFar};
  const auto estimator = estimators::make_estimator(config);
  Born born;
  int lists = 0;
  for (int drive = 1; drive <= drives; ++drive) {
    RandomStream stream({.seed = static_cast<std::uint64_t>(drive), .purpose = Purpose::kTest, .entity = 8});
    std::vector<Object> objects;
    for (int i = 0; i < 4; ++i) {
      const double bearing = i < 2 ? stream.uniform(-0.4, 0.4) : (i == 2 ? 1.0 : -1.0) * stream.uniform(0.55, 0.95);
      const double range = stream.uniform(15.0, 50.0), vx = stream.uniform(-2.0, 2.0), vy = stream.uniform(-2.0, 2.0);
      objects.push_back({range * std::cos(bearing), range * std::sin(bearing), vx, vy});
    }
    std::vector<double> since(4, 2.0);
    Timeline timeline(config, 64);
    for (std::int64_t ms = 0; ms < kUntil; ms += 20) {
      const int sensor = ms % 80 == 0 ? 0 : ms % 40 == 20 ? 1 : -1;
      if (sensor < 0) continue;
      const double half = kHalfAngle[sensor], t = 1e-3 * static_cast<double>(ms);
      std::vector<sensors::Observation> list;
      for (const Object& object : objects) {
        const double x = object.x + object.vx * t, y = object.y + object.vy * t;
        const bool seen = stream.uniform() < kSeen;
        const double dx = kSigma * stream.normal(), dy = kSigma * stream.normal();
        if (seen && std::abs(std::atan2(y, x)) < half) list.push_back(position(x + dx, y + dy, kSigma));
      }
      // The number of false ones is Poisson's: waiting times until their sum is over.
      for (double sum = -std::log(1.0 - stream.uniform()); sum < clutter * half * kFar * kFar;
           sum -= std::log(1.0 - stream.uniform())) {
        const double range = kFar * std::sqrt(stream.uniform()), bearing = stream.uniform(-half, half);
        list.push_back(position(range * std::cos(bearing), range * std::sin(bearing), kSigma));
      }
      timeline.insert(
          list_of(static_cast<std::uint8_t>(sensor), static_cast<std::uint32_t>(ms / 40), at_ms(ms), list).view());
      ++lists;
      for (const Track& track : timeline.current().tracks) {
        if (!track.confirmed) continue;
        const linear::Vector<2> at = estimator->position(track.estimate).x;
        bool is_true = false;
        for (std::size_t i = 0; i < objects.size(); ++i) {
          const linear::Vector<2> truth(objects[i].x + objects[i].vx * t, objects[i].y + objects[i].vy * t);
          if ((truth - at).norm() > 3.0) continue;
          is_true = true;
          since[i] = std::min(since[i], t);
        }
        if (!is_true) ++born.false_tracks;
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      (i < 2 ? born.in_both : born.in_one) += since[i] / (2.0 * drives);
      (i < 2 ? born.unborn_in_both : born.unborn_in_one) += (since[i] > 1.0 ? 1.0 : 0.0) / (2.0 * drives);
    }
  }
  born.false_tracks /= lists;
  std::cout << (association == config::Association::kNearest ? "nearest" : "jpda")
            << (birth == config::Birth::kMOfN ? ", m_of_n" : ", existence") << (fields_known ? ", fields" : "")
            << " at " << clutter << " per m^2: in both " << born.in_both << " s, unborn " << 100 * born.unborn_in_both
            << " %; in one " << born.in_one << " s, unborn " << 100 * born.unborn_in_one << " %; false "
            << born.false_tracks << " a list\n";
  return born;
}

constexpr int kDrives = 100;

TEST(Births, AnObjectOfOneSensorIsBornWhereFieldsAreKnown) {
  for (const double clutter : {0.0, 1e-4, 1e-3}) {
    const Born before = births(config::Birth::kMOfN, config::Association::kNearest, false, clutter, kDrives);
    const Born after = births(config::Birth::kMOfN, config::Association::kNearest, true, clutter, kDrives);
    EXPECT_GT(before.unborn_in_one, 0.9);
    EXPECT_LT(after.unborn_in_one, 0.02);
    EXPECT_LT(after.in_one, 0.45);
    EXPECT_LE(after.unborn_in_both, before.unborn_in_both + 0.01);
    EXPECT_LT(after.in_both, before.in_both + 0.02);
  }
}

TEST(Births, ExistenceBelievesLittleOfTheClutter) {
  for (const config::Association association : {config::Association::kNearest, config::Association::kJpda})
    for (const double clutter : {1e-4, 1e-3}) {
      const Born before = births(config::Birth::kExistence, association, false, clutter, kDrives);
      const Born after = births(config::Birth::kExistence, association, true, clutter, kDrives);
      EXPECT_LT(after.unborn_in_one, 0.05);
      EXPECT_LE(after.unborn_in_one, before.unborn_in_one);
      EXPECT_LT(after.in_both, before.in_both + 0.02);
      EXPECT_LT(after.false_tracks, 0.05);
    }
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
