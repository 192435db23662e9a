// A list counts for or against an object only where its sensor could have seen it. Objects are seen by one sensor, by the
// other, by both in turn. They are hidden, or gone. Every strategy, every birth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

// An object of known outline with its rear, front or side anywhere: centres are observed.
struct Body {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;
  double length = 4.4, width = 1.8, heading = 0.0;
  std::int64_t until = 1'000'000;  // [ms], when it is gone

  linear::Vector<2> at(std::int64_t ms) const {
    return {x + vx * 1e-3 * static_cast<double>(ms), y + vy * 1e-3 * static_cast<double>(ms)};
  }
  bool holds(const linear::Vector<2>& point, std::int64_t ms) const {
    const linear::Vector<2> d = point - at(ms);
    const double c = std::cos(heading), s = std::sin(heading);
    return std::abs(c * d.x() + s * d.y()) < 0.5 * length && std::abs(c * d.y() - s * d.x()) < 0.5 * width;
  }
};

// The sensors' views are decided here once more: by the middle of each object, and by steps along the line of sight.
struct Scene {
  std::vector<Body> bodies;
  std::vector<sensors::KnownSensor> sensors = std::vector<sensors::KnownSensor>(2);
  double miss_probability = 0.05;

  bool sees(int sensor, std::size_t body, std::int64_t ms) const {
    const sensors::KnownSensor& known = sensors[static_cast<std::size_t>(sensor)];
    const linear::Vector<2> at = bodies[body].at(ms);
    const double bearing = std::remainder(std::atan2(at.y(), at.x()) - known.mounting.yaw, 2.0 * kPi);
    if (ms >= bodies[body].until || std::abs(bearing) > known.field->half_angle || at.norm() > known.field->max_range)
      return false;
    for (std::size_t other = 0; other < bodies.size(); ++other)
      for (int step = 0; other != body && ms < bodies[other].until && step < 500; ++step)
        if (bodies[other].holds(step / 500.0 * at, ms)) return false;
    return true;
  }
  // The laser is sensor 0, the camera sensor 1: laser_and_camera().
  std::vector<Arrival> arrivals(std::int64_t until, std::uint64_t seed = 1) const {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest});
    std::vector<Arrival> result;
    for (std::int64_t ms = 0; ms < until; ms += 20) {
      const int sensor = ms % 80 == 0 ? 0 : ms % 40 == 20 ? 1 : -1;
      if (sensor < 0) continue;
      const double sigma = sensor == 0 ? 0.1 : 0.3;
      std::vector<sensors::Observation> list;
      for (std::size_t body = 0; body < bodies.size(); ++body) {
        const bool missed = stream.uniform() < miss_probability;
        const double dx = sigma * stream.normal(), dy = sigma * stream.normal();
        if (missed || !sees(sensor, body, ms)) continue;
        const linear::Vector<2> at = bodies[body].at(ms);
        sensors::Observation& z = list.emplace_back(position(at.x() + dx, at.y() + dy, sigma));
        z.sensor = SensorId{static_cast<std::uint8_t>(sensor)};
        z.has_heading = z.has_length = z.has_width = sensor == 0;
        z.heading = bodies[body].heading;
        z.length = bodies[body].length;
        z.width = bodies[body].width;
        z.sigma_heading = 0.02;
        z.sigma_length = z.sigma_width = 0.1;
      }
      const auto sequence = static_cast<std::uint32_t>(ms / (sensor == 0 ? 80 : 40));
      result.push_back({ms + (sensor == 0 ? stream.integer(30, 60) : stream.integer(5, 35)),
                        list_of(static_cast<std::uint8_t>(sensor), sequence, at_ms(ms), std::move(list))});
    }
    return result;
  }
};

// As in the shipped scenarios: a camera's field within a laser's.
Scene usual() {
  Scene scene;
  scene.sensors[0].field = {.half_angle = 1.05, .max_range = 120.0};
  scene.sensors[1].field = {.half_angle = 0.45, .max_range = 90.0};
  return scene;
}

class Fields : public testing::TestWithParam<std::tuple<StrategyKind, config::Birth, config::Association>> {
 protected:
  config::TrackerConfig config(const Scene& scene) const {
    config::TrackerConfig config;
    config.birth = std::get<1>(GetParam());
    config.association = std::get<2>(GetParam());
    config.sensors = scene.sensors;
    return config;
  }
  static constexpr std::int64_t kStep = 50;
  // Every 50 ms the identities of images' tracks near a body; -1: none.
  struct Seen {
    std::vector<int> track;      // near the body
    std::vector<int> elsewhere;  // number of other tracks
    int at(std::int64_t ms) const { return track[static_cast<std::size_t>(ms / kStep)]; }
    // The identities from instant to instant; -1 counts as one.
    std::set<int> between(std::int64_t from, std::int64_t to) const {
      return {track.begin() + from / kStep, track.begin() + to / kStep};
    }
  };
  Seen follow(const Scene& scene, std::size_t body, std::int64_t until, const config::TrackerConfig& config,
              std::uint64_t seed = 1) const {
    std::vector<Arrival> arrivals = scene.arrivals(until, seed);
    sort_by_arrival(arrivals);
    const auto strategy = make_strategy(std::get<0>(GetParam()), config, laser_and_camera());
    std::vector<tracks::TrackView> image;
    Seen seen;
    std::size_t next = 0;
    for (std::int64_t now = 0; now < until; now += 10) {
      for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) strategy->accept(arrivals[next].list.view());
      strategy->fuse(at_ms(now));
      if (now % kStep != 0) continue;
      strategy->image(at_ms(now), image);
      seen.track.push_back(-1);
      seen.elsewhere.push_back(0);
      for (const tracks::TrackView& view : image) {
        if ((view.state.head<2>() - scene.bodies[body].at(now)).norm() < 3.0)
          seen.track.back() = static_cast<int>(index_of(view.id));
        else
          ++seen.elsewhere.back();
      }
    }
    return seen;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Fields,
                         testing::Combine(testing::ValuesIn(kAllStrategies),
                                          testing::Values(config::Birth::kMOfN, config::Birth::kExistence),
                                          testing::Values(config::Association::kNearest, config::Association::kJpda)),
                         [](const auto& way) {
                           return std::string(name_of(std::get<0>(way.param))) +
                                  (std::get<1>(way.param) == config::Birth::kMOfN ? "MOfN" : "Existence") +
                                  (std::get<2>(way.param) == config::Association::kNearest ? "Nearest" : "Jpda");
                         });

// 40 degrees aside: the camera's lists are empty twice as often as the laser sees the car.
TEST_P(Fields, OneSensorIsEnough) {
  Scene scene = usual();
  scene.bodies = {{.x = 20.0, .y = 17.0}};
  const Seen seen = follow(scene, 0, 4000, config(scene));
  EXPECT_EQ(seen.between(800, 4000).size(), 1u) << "one identity";
  EXPECT_GE(seen.at(800), 0);
}

TEST_P(Fields, WithoutAKnownFieldTheOtherSensorOutvotesIt) {
  if (std::get<1>(GetParam()) != config::Birth::kMOfN) return;
  Scene scene = usual();
  scene.bodies = {{.x = 20.0, .y = 17.0}};
  config::TrackerConfig unknowing = config(scene);
  unknowing.sensors.clear();
  EXPECT_EQ(follow(scene, 0, 4000, unknowing).between(0, 4000), std::set<int>{-1});
}

// The laser looks to the right, the camera to the left. A car crosses both fields, then it is in none:
//   y = -30..-3 the laser's, -3..10 both, 10..28 the camera's.
TEST_P(Fields, SensorsInTurnShowOneObject) {
  Scene scene;
  scene.sensors[0].mounting.yaw = -0.4;
  scene.sensors[0].field = {.half_angle = 0.65, .max_range = 120.0};
  scene.sensors[1].mounting.yaw = 0.27;
  scene.sensors[1].field = {.half_angle = 0.35, .max_range = 90.0};
  scene.bodies = {{.x = 40.0, .y = -30.0, .vy = 15.0, .heading = 0.5 * kPi}};
  const Seen seen = follow(scene, 0, 6000, config(scene));
  EXPECT_GE(seen.at(800), 0);
  EXPECT_EQ(seen.between(800, 3800).size(), 1u) << "one identity";
  EXPECT_FALSE(scene.sees(0, 0, 2700));
  EXPECT_TRUE(scene.sees(1, 0, 2700));
  EXPECT_FALSE(scene.sees(1, 0, 4000));
  // It leaves unseen. It ends by silence, delete_after 1 s.
  EXPECT_EQ(seen.between(5100, 6000), std::set<int>{-1});
  EXPECT_EQ(*std::max_element(seen.elsewhere.begin() + 5100 / kStep, seen.elsewhere.end()), 0);
}

// A car passes behind a lorry of 10 m, whose rear is 10 m away. Its middle is hidden for 0.8 s, some 29 lists.
TEST_P(Fields, AHiddenObjectKeepsItsTrack) {
  Scene scene = usual();
  scene.bodies = {{.x = 40.0, .y = -22.0, .vy = 12.0, .heading = 0.5 * kPi},
                  {.x = 15.0, .y = 0.0, .length = 10.0, .width = 2.5}};
  int hidden = 0;
  for (std::int64_t ms = 0; ms < 3500; ms += 20)
    if (ms % 80 == 0 || ms % 40 == 20) hidden += !scene.sees(ms % 80 == 0 ? 0 : 1, 0, ms);
  EXPECT_GT(hidden, 24);
  const Seen seen = follow(scene, 0, 3500, config(scene));
  EXPECT_GE(seen.at(800), 0);
  EXPECT_EQ(seen.between(800, 3500).size(), 1u) << "one identity";
}

// A lorry crosses before a standing car and hides it for 2 s, twice delete_after.
TEST_P(Fields, ATrackThatStaysHiddenEndsByItsAge) {
  Scene scene = usual();
  scene.bodies = {{.x = 40.0, .y = 0.0},
                  {.x = 15.0, .y = -14.0, .vy = 5.0, .length = 10.0, .width = 2.5, .heading = 0.5 * kPi}};
  std::int64_t last = 0;
  for (std::int64_t ms = 0; ms < 3600; ms += 20)
    if (scene.sees(0, 0, ms)) last = ms;
  ASSERT_EQ(last, 1800);
  const Seen seen = follow(scene, 0, 3600, config(scene));
  EXPECT_EQ(seen.between(800, 2500).size(), 1u);
  EXPECT_GE(seen.at(800), 0);
  EXPECT_EQ(seen.between(2900, 3600), std::set<int>{-1});
}

// Nothing hides this one: it is gone after eight lists, as ever.
TEST_P(Fields, ATrackEndsAtOnceIfItsObjectIsGoneInView) {
  Scene scene = usual();
  scene.bodies = {{.x = 40.0, .y = 0.0, .until = 1500}};
  const Seen seen = follow(scene, 0, 2500, config(scene));
  EXPECT_EQ(seen.between(800, 1500).size(), 1u);
  EXPECT_GE(seen.at(800), 0);
  EXPECT_EQ(seen.between(1900, 2500), std::set<int>{-1});
}

// Late lists are judged at their own instants.
TEST_P(Fields, EveryOrderOfArrivalGivesTheSameBits) {
  Scene scene = usual();
  scene.bodies = {{.x = 40.0, .y = -22.0, .vy = 12.0, .heading = 0.5 * kPi},
                  {.x = 15.0, .y = 0.0, .length = 10.0, .width = 2.5},
                  {.x = 20.0, .y = 17.0, .vx = 5.0},
                  {.x = 60.0, .y = 0.0, .vy = 3.0}};
  std::vector<Arrival> arrivals = scene.arrivals(3000);
  tracks::Timeline in_order(config(scene), 32);
  std::vector<Arrival> sorted = arrivals;
  std::sort(sorted.begin(), sorted.end(), [](const Arrival& a, const Arrival& b) {
    return tracks::before(a.list.id, a.list.measured, b.list.id, b.list.measured);
  });
  for (const Arrival& arrival : sorted) in_order.insert(arrival.list.view());
  ASSERT_GE(in_order.current().tracks.size(), 4u);
  RandomStream stream({.seed = 9});
  for (int shuffle = 0; shuffle < 3; ++shuffle) {
    for (Arrival& arrival : arrivals) arrival.ms = arrival.list.measured.ns / 1'000'000 + stream.integer(0, 300);
    sort_by_arrival(arrivals);
    tracks::Timeline timeline(config(scene), 32);
    for (const Arrival& arrival : arrivals) timeline.insert(arrival.list.view());
    EXPECT_TRUE(same_bits(timeline.current(), in_order.current())) << shuffle;
  }
}

}  // namespace
}  // namespace ttf::fusion::strategies
