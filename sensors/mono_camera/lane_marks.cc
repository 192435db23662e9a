#include "sensors/mono_camera/lane_marks.h"

#include <cmath>

#include "core/random.h"
#include "sensors/clutter.h"

namespace ttf::sensors::mono_camera {
namespace {

// The boxes of the same list have the streams' earlier blocks: 5000 objects need fewer than 20000.
constexpr std::uint32_t kFirstBlock = 1U << 20;

}  // namespace

LaneMarkConfig load_lane_marks(YamlMap& yaml) {
  LaneMarkConfig c;
  c.ahead_m = yaml.number_or("ahead", c.ahead_m, {0.0, 100.0}, "m");
  c.widest_m = yaml.number_or("widest", c.widest_m, {0.1, 100.0}, "m");
  c.offset_sigma_m = yaml.number_or("offset_sigma", c.offset_sigma_m, {0.0, 5.0}, "m");
  c.heading_sigma_rad = yaml.number_or("heading_sigma", c.heading_sigma_rad, {0.0, 0.5}, "rad");
  c.curvature_sigma_per_m = yaml.number_or("curvature_sigma", c.curvature_sigma_per_m, {0.0, 0.1}, "1/m");
  c.miss_probability = yaml.number_or("miss_probability", c.miss_probability, {0.0, 1.0});
  c.false_per_list = yaml.number_or("false_per_list", c.false_per_list, {0.0, 10.0});
  return c;
}

void measure_lane_marks(const LaneMarkConfig& config, std::span<const LaneMark> marks, const MeasurementKey& key,
                        std::size_t capacity, std::vector<LaneMark>& seen, std::vector<std::uint16_t>& truth) {
  seen.clear();
  truth.clear();
  RandomStream noise(key.of(Purpose::kSensorNoise), kFirstBlock);
  RandomStream misses(key.of(Purpose::kSensorMisses), kFirstBlock);
  RandomStream others(key.of(Purpose::kClutter), kFirstBlock);
  for (std::size_t i = 0; i < marks.size() && i < LaneMarkConfig::kMost; ++i) {
    // Every mark gets draws, seen or not.
    const bool missed = misses.uniform() < config.miss_probability;
    const double offset = noise.normal(), heading = noise.normal(), curvature = noise.normal();
    if (missed || std::abs(marks[i].offset) > config.widest_m || seen.size() == capacity) continue;
    seen.push_back({marks[i].offset + config.offset_sigma_m * offset,
                    marks[i].heading + config.heading_sigma_rad * heading,
                    marks[i].curvature + config.curvature_sigma_per_m * curvature});
    truth.push_back(static_cast<std::uint16_t>(i));
  }
  for (int n = poisson(others, config.false_per_list); n > 0; --n) {
    const double offset = others.uniform(-config.widest_m, config.widest_m);
    const double heading = 0.05 * others.normal(), curvature = 0.002 * others.normal();
    if (seen.size() == capacity) break;
    seen.push_back({offset, heading, curvature});
    truth.push_back(0xffff);
  }
}

}  // namespace ttf::sensors::mono_camera
