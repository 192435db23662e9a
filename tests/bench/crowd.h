// 25 objects for 16 s, as two sensors see them, and strategies that have tracked them for a while.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fusion/strategy.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion {

inline constexpr std::uint32_t kCycles = 400;

// Laser and camera see all 25 objects every 40 ms, the camera 20 ms later.
struct Crowd {
  std::vector<OwnedScan> laser, camera;
  const std::vector<SensorTiming> sensors{
      {SensorId{0}, Settling::after(Duration::milliseconds(60)), true, at_ms(0), Duration::milliseconds(40)},
      {SensorId{1}, Settling::after(Duration::milliseconds(35)), true, at_ms(20), Duration::milliseconds(40)}};

  Crowd() {
    const Lanes seen_by_laser{.seed = 1}, seen_by_camera{.sigma = 0.4, .seed = 2};
    for (std::uint32_t k = 0; k < kCycles; ++k) {
      laser.push_back(scan(0, k, at_ms(40 * k), seen_by_laser.see(at_ms(40 * k), k)));
      camera.push_back(scan(1, k, at_ms(40 * k + 20), seen_by_camera.see(at_ms(40 * k + 20), k)));
    }
  }
  std::unique_ptr<Strategy> start(StrategyKind kind, std::uint32_t cycles, const TrackerConfig& config = {}) const {
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
  static const Crowd the_crowd;
  return the_crowd;
}

inline constexpr std::uint32_t kWarm = 40;  // cycles: 80 scans, more than the history holds

}  // namespace ttf::fusion
