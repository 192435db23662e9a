#include "sensors/laser/model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/random.h"
#include "sensors/shape.h"

namespace ttf::sensors::laser {
namespace {

// A beam's own part of the scan's stream: in every layer a uniform number and a normal one.
constexpr std::uint32_t kWordsOfABeam = LaserConfig::kMostLayers * RandomStream::kWordsOfUniform +
                                        (LaserConfig::kMostLayers + 1) / 2 * RandomStream::kWordsOfANormalPair;
constexpr std::uint32_t kBlocksOfABeam =
    (kWordsOfABeam + RandomStream::kWordsOfABlock - 1) / RandomStream::kWordsOfABlock;

// The largest half_field over the smallest azimuth_step of load_laser().
constexpr int kMostBeamsOfASide = 1400;

// The first object that a beam meets.
struct Echo {
  double range;
  const ObjectState* object;  // null: no echo
};

// The azimuths of a scan's beams.
struct Beams {
  double step, phase;  // [rad], [steps]
  double azimuth(int beam) const { return (beam + phase) * step; }
};

// Behind all beams' parts of the scan's stream.
double phase_of(const LaserConfig& config, const StreamKey& key) {
  if (config.azimuth_phase == AzimuthPhase::kFixed) return 0.0;
  return RandomStream(key, kBlocksOfABeam * (2 * kMostBeamsOfASide + 1)).uniform(-0.5, 0.5);
}

// Returns the first and the last beam of -half..half that may meet the object. They pass its centre no further
// than its outline reaches, and a little more.
std::pair<int, int> beams_near(const ObjectState& object, const Beams& beams, int half) {
  const double reach = 0.5 * std::hypot(object.length, object.width) * 1.001;
  const double distance = std::hypot(object.x, object.y);
  if (distance <= reach) return {-half, half};
  const double bearing = std::atan2(object.y, object.x), spread = std::asin(reach / distance);
  const double widest = half + 1.0;
  const auto beam = [&](double azimuth) {
    return static_cast<int>(std::clamp(azimuth / beams.step - beams.phase, -widest, widest));
  };
  return {std::max(-half, beam(bearing - spread) - 1), std::min(half, beam(bearing + spread) + 1)};
}

}  // namespace

LaserConfig load_laser(YamlMap& yaml) {
  LaserConfig c;
  c.layers = static_cast<int>(yaml.integer_or("layers", c.layers, {1, LaserConfig::kMostLayers}));
  c.azimuth_step_rad = yaml.number_or("azimuth_step", c.azimuth_step_rad, {0.001, 0.1}, "rad");
  c.azimuth_phase = yaml.choice_or<AzimuthPhase>("azimuth_phase", c.azimuth_phase,
                                                 {{"fixed", AzimuthPhase::kFixed}, {"drawn", AzimuthPhase::kDrawn}});
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

LaserConfig in_weather(LaserConfig laser, const sim::world::Weather& weather) {
  laser.max_range_m *= weather.laser_range;
  laser.miss_at_100m *= weather.laser_misses;
  return laser;
}

LaserConfig in_drive(LaserConfig config, const DriveKey& key) {
  config.range_bias = in_drive(config.range_bias, ErrorOf::kRange, key);
  config.azimuth_bias = in_drive(config.azimuth_bias, ErrorOf::kBearing, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

void measure_laser(const LaserConfig& config, std::span<const ObjectState> objects, const MeasurementKey& key,
                   std::vector<HitPoint>& hits, std::vector<ObjectId>& truth) {
  TTF_CHECK(config.layers <= LaserConfig::kMostLayers, "{} layers", config.layers);
  hits.clear();
  truth.clear();
  const StreamKey noise_of_scan = key.of(Purpose::kSensorNoise);
  const Beams beams{config.azimuth_step_rad, phase_of(config, noise_of_scan)};
  const auto half = static_cast<int>(config.half_field_rad / config.azimuth_step_rad);
  TTF_CHECK(half >= 0 && half <= kMostBeamsOfASide, "{} beams to a side", half);
  // By beam + half. Only beams from `begin` to before `end` are filled, since most beams meet no object.
  std::array<Echo, 2 * kMostBeamsOfASide + 1> echoes;
  int begin = 0, end = 0;
  const auto fill = [&](int from, int to) {
    if (from < to) std::fill_n(echoes.begin() + from + half, to - from, Echo{config.max_range_m, nullptr});
  };
  for (const ObjectState& object : objects) {
    const auto [first, last] = beams_near(object, beams, half);
    if (first > last) continue;
    if (begin == end) begin = end = first;
    fill(first, begin);
    fill(end, last + 1);
    begin = std::min(begin, first);
    end = std::max(end, last + 1);
    const RayTarget target(object);
    for (int beam = first; beam <= last; ++beam) {
      Echo& echo = echoes[static_cast<std::size_t>(beam + half)];
      if (const auto range = target.ray_to(beams.azimuth(beam)); range && *range < echo.range) echo = {*range, &object};
    }
  }
  for (int beam = begin; beam < end; ++beam) {
    const double azimuth = beams.azimuth(beam);
    const auto [nearest, hit] = echoes[static_cast<std::size_t>(beam + half)];
    if (hit == nullptr || config.device.blind.hold(azimuth)) continue;
    const double loss = std::min(1.0, config.miss_at_100m * nearest * nearest * 1e-4);
    RandomStream noise(noise_of_scan, kBlocksOfABeam * static_cast<std::uint32_t>(beam + half));
    for (int layer = 0; layer < config.layers; ++layer) {
      const bool lost = noise.uniform() < loss;
      const double range = nearest + config.range_bias.fixed + config.range_sigma_m * noise.normal();
      if (lost || range <= 0.0 || static_cast<int>(hits.size()) == config.max_hits) continue;
      hits.push_back({layer, azimuth + config.azimuth_bias.fixed, range});
      truth.push_back(hit->id);
    }
  }
}

}  // namespace ttf::sensors::laser
