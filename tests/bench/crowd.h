// Objects as two sensors see them, and strategies that have tracked them for a while: 25 for 16 s, and 1,000.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fusion/strategies/strategy.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion {

inline constexpr std::uint32_t kCycles = 400;
inline constexpr std::uint32_t kWarm = 40;  // cycles: 80 lists, more than the history holds

// Laser and camera see all objects every 40 ms, the camera 20 ms later.
struct Crowd {
  std::vector<OwnedList> laser, camera;
  const std::vector<strategies::SensorTiming> sensors{
      {SensorId{0}, strategies::Settling::after(Duration::milliseconds(60)), true, at_ms(0),
       Duration::milliseconds(40)},
      {SensorId{1}, strategies::Settling::after(Duration::milliseconds(35)), true, at_ms(20),
       Duration::milliseconds(40)}};

  explicit Crowd(const Lanes& lanes, std::uint32_t cycles) {
    Lanes seen_by_laser = lanes, seen_by_camera = lanes;
    seen_by_laser.seed = 1;
    seen_by_camera.seed = 2;
    seen_by_camera.sigma = 0.4;
    for (std::uint32_t k = 0; k < cycles; ++k) {
      laser.push_back(list_of(0, k, at_ms(40 * k), seen_by_laser.see(at_ms(40 * k), k)));
      camera.push_back(list_of(1, k, at_ms(40 * k + 20), seen_by_camera.see(at_ms(40 * k + 20), k)));
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

// Objects 6 m and 12 m apart, 25 to 1,000.
inline Crowd crowd_of(int objects) {
  return Crowd({.objects = objects, .across = objects < 100 ? 5 : objects < 1000 ? 20 : 40}, kWarm + 40);
}
inline const Crowd& thousand() {
  static const Crowd the_crowd = crowd_of(1000);
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
