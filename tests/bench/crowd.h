// Objects as two sensors see them, and strategies that have tracked them for a while: 25 for 16 s, and 1,000.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/random.h"
#include "fusion/strategies/strategy.h"
#include "fusion/tracks/body/anchor.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion {

inline constexpr std::uint32_t kCycles = 400;
inline constexpr std::uint32_t kWarm = 40;  // cycles: 80 lists, more than the history holds

// Centres are located by both sensors, with all sizes. Or the laser locates ends, with their width, and the camera
// silhouettes: so does preprocessing on a road.
enum class Locates : std::uint8_t { kCentres, kOutlines };

// Cars whose ends or silhouettes are seen from the origin, in shuffled order.
struct Outlines {
  Lanes lanes;
  sensors::SeenPoint point = sensors::SeenPoint::kEnd;

  static tracks::body::Box box_of(const estimators::State& car) { return {{4.5, 1.8}, std::atan2(car(3), car(2))}; }
  linear::Vector<2> middle_of(const estimators::State& car) const {
    const linear::Vector<2> centre = car.head<2>();
    const tracks::body::Box box = box_of(car);
    return tracks::body::point_of(tracks::body::anchor_of(point, centre, box.heading, {0.0, 0.0}), {}, centre, box)->at;
  }
  sensors::Observation of(const estimators::State& car, RandomStream& stream) const {
    const linear::Vector<2> centre = car.head<2>(), at = middle_of(car);
    const tracks::body::Box box = box_of(car);
    const bool end = point == sensors::SeenPoint::kEnd;
    sensors::Observation z =
        position(at.x() + lanes.sigma * stream.normal(), at.y() + lanes.sigma * stream.normal(), lanes.sigma);
    z.seen = point;
    z.has_heading = z.has_width = end;
    z.has_span = !end;
    z.sigma_heading = 0.03;
    z.sigma_width = 0.1;
    z.sigma_span = 0.003;
    z.heading = box.heading + z.sigma_heading * stream.normal();
    z.width = box.size(1) + z.sigma_width * stream.normal();
    z.span = tracks::body::silhouette_of(centre, box)->span + z.sigma_span * stream.normal();
    return z;
  }
  std::vector<sensors::Observation> see(GlobalTime at, std::uint32_t index) const {
    RandomStream stream({.seed = lanes.seed, .purpose = Purpose::kTest, .entity = 78, .index = index});
    std::vector<sensors::Observation> seen;
    for (int object = 0; object < lanes.objects; ++object) seen.push_back(of(lanes.truth(object, at), stream));
    for (std::size_t i = seen.size(); i > 1; --i)
      std::swap(seen[i - 1], seen[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i) - 1))]);
    return seen;
  }
};

// Laser and camera see all objects every 40 ms, the camera 20 ms later.
struct Crowd {
  std::vector<OwnedList> laser, camera;
  const std::vector<strategies::SensorTiming> sensors{
      {SensorId{0}, strategies::Settling::after(Duration::milliseconds(60)), true, at_ms(0),
       Duration::milliseconds(40)},
      {SensorId{1}, strategies::Settling::after(Duration::milliseconds(35)), true, at_ms(20),
       Duration::milliseconds(40)}};

  explicit Crowd(const Lanes& lanes, std::uint32_t cycles, Locates locates = Locates::kCentres) {
    Lanes seen_by_laser = lanes, seen_by_camera = lanes;
    seen_by_laser.seed = 1;
    seen_by_camera.seed = 2;
    seen_by_camera.sigma = 0.4;
    const auto see = [&](const Lanes& seen, sensors::SeenPoint point, GlobalTime at, std::uint32_t k) {
      return locates == Locates::kCentres ? seen.see(at, k) : Outlines{seen, point}.see(at, k);
    };
    for (std::uint32_t k = 0; k < cycles; ++k) {
      const GlobalTime first = at_ms(40 * k), second = at_ms(40 * k + 20);
      laser.push_back(list_of(0, k, first, see(seen_by_laser, sensors::SeenPoint::kEnd, first, k)));
      camera.push_back(list_of(1, k, second, see(seen_by_camera, sensors::SeenPoint::kSilhouette, second, k)));
    }
  }
  std::unique_ptr<strategies::Strategy> start(strategies::StrategyKind kind, std::uint32_t cycles,
                                              const config::TrackerConfig& config = {}) const {
    auto strategy = make_strategy(kind, config, sensors);
    for (std::uint32_t k = 0; k < cycles; ++k) {
      strategy->accept(laser[k].view());
      strategy->accept(camera[k].view());
      strategy->fuse(camera[k].measured + Duration::milliseconds(60));
    }
    return strategy;
  }
};

inline const Crowd& scene() {
  static const Crowd the_crowd({}, kCycles);
  return the_crowd;
}
inline const Crowd& road() {
  static const Crowd the_crowd({}, kCycles, Locates::kOutlines);
  return the_crowd;
}

// Objects 6 m and 12 m apart, 25 to 1,000.
inline Crowd crowd_of(int objects, Locates locates = Locates::kCentres) {
  return Crowd({.objects = objects, .across = objects < 100 ? 5 : objects < 1000 ? 20 : 40}, kWarm + 40, locates);
}
inline const Crowd& thousand() {
  static const Crowd the_crowd = crowd_of(1000);
  return the_crowd;
}
inline const Crowd& thousand_on_the_road() {
  static const Crowd the_crowd = crowd_of(1000, Locates::kOutlines);
  return the_crowd;
}
// A tracker with room for just as many.
inline config::TrackerConfig for_crowd_of(int objects) {
  config::TrackerConfig config;
  config.max_objects = objects;
  config.max_observations = static_cast<std::size_t>(objects);
  config.history_scans = 16;
  return config;
}
inline config::TrackerConfig for_thousand() { return for_crowd_of(1000); }

}  // namespace ttf::fusion
