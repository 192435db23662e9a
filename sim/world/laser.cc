#include "sim/world/laser.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"
#include "sim/world/shape.h"

namespace ttf::world {
namespace {

// A beam's own part of the scan's stream: in every layer a uniform number and a normal one.
constexpr std::uint32_t kWordsOfABeam = LaserConfig::kMostLayers * RandomStream::kWordsOfUniform +
                                        (LaserConfig::kMostLayers + 1) / 2 * RandomStream::kWordsOfANormalPair;
constexpr std::uint32_t kBlocksOfABeam =
    (kWordsOfABeam + RandomStream::kWordsOfABlock - 1) / RandomStream::kWordsOfABlock;

}  // namespace

LaserConfig load_laser(YamlMap& yaml) {
  LaserConfig c;
  c.layers = static_cast<int>(yaml.integer_or("layers", c.layers, {1, LaserConfig::kMostLayers}));
  c.azimuth_step_rad = yaml.number_or("azimuth_step", c.azimuth_step_rad, {0.001, 0.1}, "rad");
  c.half_field_rad = yaml.number_or("half_field", c.half_field_rad, {0.01, 1.4}, "rad");
  c.range_sigma_m = yaml.number_or("range_sigma", c.range_sigma_m, {0.0, 2.0}, "m");
  c.max_range_m = yaml.number_or("max_range", c.max_range_m, {1.0, 199.0}, "m");
  c.miss_at_100m = yaml.number_or("miss_at_100m", c.miss_at_100m, {0.0, 1.0});
  c.range_bias.fixed = yaml.number_or("range_bias", 0.0, {-5.0, 5.0}, "m");
  c.range_bias.sigma = yaml.number_or("range_bias_sigma", 0.0, {0.0, 5.0}, "m");
  c.azimuth_bias.fixed = yaml.number_or("azimuth_bias", 0.0, {-0.2, 0.2}, "rad");
  c.azimuth_bias.sigma = yaml.number_or("azimuth_bias_sigma", 0.0, {0.0, 0.2}, "rad");
  c.device = load_device(yaml);
  return c;
}

LaserConfig in_drive(LaserConfig config, const DriveKey& key) {
  config.range_bias = in_drive(config.range_bias, ErrorOf::kRange, key);
  config.azimuth_bias = in_drive(config.azimuth_bias, ErrorOf::kBearing, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

void measure_laser(const LaserConfig& config, std::span<const ObjectState> objects, std::uint64_t seed,
                   std::uint32_t replication, std::uint16_t sensor, std::uint32_t sequence,
                   std::vector<HitPoint>& hits, std::vector<ObjectId>& truth) {
  TTF_CHECK(config.layers <= LaserConfig::kMostLayers, "{} layers", config.layers);
  hits.clear();
  truth.clear();
  const auto half = static_cast<int>(config.half_field_rad / config.azimuth_step_rad);
  for (int beam = -half; beam <= half; ++beam) {
    const double azimuth = beam * config.azimuth_step_rad;
    double nearest = config.max_range_m;
    const ObjectState* hit = nullptr;
    for (const ObjectState& object : objects) {
      // Cheap bound: the beam passes further from the centre than the outline reaches.
      const double reach = 0.5 * std::hypot(object.length, object.width);
      const double across = -std::sin(azimuth) * object.x + std::cos(azimuth) * object.y;
      if (std::abs(across) > reach) continue;
      if (const auto range = ray_to(object, azimuth); range && *range < nearest) {
        nearest = *range;
        hit = &object;
      }
    }
    if (hit == nullptr) continue;
    const double loss = std::min(1.0, config.miss_at_100m * nearest * nearest * 1e-4);
    RandomStream noise({seed, replication, Purpose::kSensorNoise, sensor, sequence},
                       kBlocksOfABeam * static_cast<std::uint32_t>(beam + half));
    for (int layer = 0; layer < config.layers; ++layer) {
      const bool lost = noise.uniform() < loss;
      const double range = nearest + config.range_bias.fixed + config.range_sigma_m * noise.normal();
      if (lost || range <= 0.0 || static_cast<int>(hits.size()) == config.max_hits) continue;
      hits.push_back({layer, azimuth + config.azimuth_bias.fixed, range});
      truth.push_back(hit->id);
    }
  }
}

}  // namespace ttf::world
