#include "sensors/radar/model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/check.h"
#include "core/random.h"
#include "sensors/clutter.h"
#include "sensors/shape.h"

namespace ttf::sensors::radar {
namespace {

// An object's own part of the list's stream: each point's place and echo, and three errors.
constexpr std::uint32_t kWordsOfAPoint = 2 * RandomStream::kWordsOfUniform + 2 * RandomStream::kWordsOfANormalPair;
constexpr std::uint32_t kBlocksOfAnObject =
    RadarConfig::kMostPoints * ((kWordsOfAPoint + RandomStream::kWordsOfABlock - 1) / RandomStream::kWordsOfABlock);

// A point of an object's outline, from the antenna. It moves with the object, and turns about its centre.
struct Point {
  double range = 0.0, azimuth = 0.0, rate = 0.0;
};
Point point_at(const ObjectState& object, double range, double azimuth, const AntennaVelocity& antenna) {
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const double vx = object.speed * std::cos(object.heading) - object.yaw_rate * (range * s - object.y) - antenna.x;
  const double vy = object.speed * std::sin(object.heading) + object.yaw_rate * (range * c - object.x) - antenna.y;
  return {range, azimuth, c * vx + s * vy};
}

// Hidden objects are those whose middle is.
Sight sight_to(const ObjectState& object, const std::optional<AzimuthSpan>& span, const RadarConfig& config) {
  if (!span) return {};
  const double middle = 0.5 * (span->low + span->high), half = 0.5 * (span->high - span->low);
  const auto range = RayTarget(object).ray_to(middle);
  if (!range) return {};
  return {middle, *range, half, true, *range <= config.max_range_m && std::abs(middle) - half <= config.half_field_rad};
}

std::int64_t cell_of(double value, double cell) { return static_cast<std::int64_t>(std::floor(value / cell)); }

double decibels(double power) { return 10.0 * std::log10(power); }

}  // namespace

RadarConfig load_radar(YamlMap& yaml) {
  RadarConfig c;
  c.half_field_rad = yaml.number_or("half_field", c.half_field_rad, {0.01, 1.5}, "rad");
  c.max_range_m = yaml.number_or("max_range", c.max_range_m, {1.0, 320.0}, "m");
  c.beam_width_rad = yaml.number_or("beam_width", c.beam_width_rad, {0.01, 6.0}, "rad");
  c.range_sigma_m = yaml.number_or("range_sigma", c.range_sigma_m, {0.0, 5.0}, "m");
  c.azimuth_sigma_rad = yaml.number_or("azimuth_sigma", c.azimuth_sigma_rad, {0.0, 0.2}, "rad");
  c.rate_sigma_mps = yaml.number_or("range_rate_sigma", c.rate_sigma_mps, {0.0, 5.0}, "m/s");
  c.range_cell_m = yaml.number_or("range_cell", c.range_cell_m, {0.01, 50.0}, "m");
  c.azimuth_cell_rad = yaml.number_or("azimuth_cell", c.azimuth_cell_rad, {0.001, 1.0}, "rad");
  c.rate_cell_mps = yaml.number_or("range_rate_cell", c.rate_cell_mps, {0.01, 20.0}, "m/s");
  c.rate_span_mps = yaml.number_or("range_rate_span", c.rate_span_mps, {1.0, 400.0}, "m/s");
  c.most_returns = static_cast<int>(yaml.integer_or("most_returns", c.most_returns, {1, RadarConfig::kMostPoints}));
  c.snr_at_100m_db = yaml.number_or("snr_at_100m", c.snr_at_100m_db, {-40.0, 80.0}, "dB");
  c.false_alarm_probability = yaml.number_or("false_alarm_probability", c.false_alarm_probability, {1e-12, 0.1});
  c.attenuation_db_per_km = yaml.number_or("attenuation", c.attenuation_db_per_km, {0.0, 100.0}, "dB/km");
  c.shadow = yaml.number_or("shadow", c.shadow, {0.0, 1e6});
  c.clutter_per_list = yaml.number_or("clutter_per_list", c.clutter_per_list, {0.0, 20.0});
  c.range_bias.fixed = yaml.number_or("range_bias", 0.0, {-5.0, 5.0}, "m");
  c.range_bias.sigma = yaml.number_or("range_bias_sigma", 0.0, {0.0, 5.0}, "m");
  c.azimuth_bias.fixed = yaml.number_or("azimuth_bias", 0.0, {-0.2, 0.2}, "rad");
  c.azimuth_bias.sigma = yaml.number_or("azimuth_bias_sigma", 0.0, {0.0, 0.2}, "rad");
  c.rate_bias.fixed = yaml.number_or("range_rate_bias", 0.0, {-5.0, 5.0}, "m/s");
  c.rate_bias.sigma = yaml.number_or("range_rate_bias_sigma", 0.0, {0.0, 5.0}, "m/s");
  c.device = load_device(yaml);
  if (!c.device.enabled) c.clutter_per_list = 0.0;
  return c;
}

RadarConfig in_weather(RadarConfig radar, const sim::world::Weather& weather) {
  radar.attenuation_db_per_km += weather.radar_attenuation_db_per_km;
  radar.clutter_per_list *= weather.radar_clutter;
  return radar;
}

RadarConfig in_drive(RadarConfig config, const DriveKey& key) {
  config.range_bias = in_drive(config.range_bias, ErrorOf::kRange, key);
  config.azimuth_bias = in_drive(config.azimuth_bias, ErrorOf::kBearing, key);
  config.rate_bias = in_drive(config.rate_bias, ErrorOf::kRangeRate, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

double snr_of(const RadarConfig& config, double cross_section, double range, double azimuth) {
  const double off = 2.0 * azimuth / config.beam_width_rad, near = 100.0 / range;
  const double gain_db = -decibels(2.0) * off * off;  // one way: half of the gain at half of the width
  const double lost_db = 2.0 * config.attenuation_db_per_km * range * 1e-3;
  return cross_section * std::pow(10.0, 0.1 * (config.snr_at_100m_db + 2.0 * gain_db - lost_db)) * near * near * near *
         near;
}

double detection_probability(const RadarConfig& config, double snr) {
  return std::pow(config.false_alarm_probability, 1.0 / (1.0 + snr));
}

double folded(double range_rate, double span) { return std::remainder(range_rate, span); }

AntennaVelocity antenna_velocity(const EgoState& ego, const Placement& placement) {
  const double vx = ego.vx - ego.yaw_rate * placement.y, vy = ego.vy + ego.yaw_rate * placement.x;
  const double c = std::cos(placement.heading), s = std::sin(placement.heading);
  return {c * vx + s * vy, -s * vx + c * vy};
}

RadarRoom::RadarRoom(std::size_t most_objects) : occlusion_(most_objects), sights_(most_objects) {
  echoes_.reserve(most_objects * static_cast<std::size_t>(RadarConfig::kMostPoints));
}

void measure_radar(const RadarConfig& config, std::span<const ObjectState> objects, const AntennaVelocity& antenna,
                   const MeasurementKey& key, RadarRoom& room, std::vector<RadarReturn>& returns,
                   std::vector<ObjectId>& truth) {
  TTF_CHECK(config.most_returns <= RadarConfig::kMostPoints, "{} points", config.most_returns);
  returns.clear();
  truth.clear();
  room.echoes_.clear();
  for (std::size_t i = 0; i < objects.size(); ++i)
    room.sights_[i] = sight_to(objects[i], azimuth_span(objects[i]), config);
  std::span<const char> hidden;
  if (config.shadow > 0.0)
    hidden = room.occlusion_.hidden(objects, std::span(room.sights_).first(objects.size()), config.shadow);
  const StreamKey noise = key.of(Purpose::kSensorNoise);
  const double threshold = -std::log(config.false_alarm_probability);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Sight& sight = room.sights_[i];
    if (!sight.wanted || (!hidden.empty() && hidden[i])) continue;
    const RayTarget target(objects[i]);
    RandomStream draws(noise, kBlocksOfAnObject * static_cast<std::uint32_t>(index_of(objects[i].id)));
    for (int p = 0; p < config.most_returns; ++p) {
      const double azimuth = sight.bearing + sight.half_width * draws.uniform(-1.0, 1.0), chance = draws.uniform();
      const double errors[] = {draws.normal(), draws.normal(), draws.normal()};
      const auto range = target.ray_to(azimuth);
      if (!range || *range > config.max_range_m || std::abs(azimuth) > config.half_field_rad ||
          config.device.blind.hold(azimuth))
        continue;
      const double snr = snr_of(config, objects[i].cross_section / config.most_returns, *range, azimuth);
      // Above the threshold with the probability P_d.
      const double power = -(1.0 + snr) * std::log1p(-chance);
      if (power <= threshold) continue;
      const Point point = point_at(objects[i], *range, azimuth, antenna);
      const double rate = folded(point.rate, config.rate_span_mps);
      room.echoes_.push_back({cell_of(point.range, config.range_cell_m), cell_of(azimuth, config.azimuth_cell_rad),
                              cell_of(rate, config.rate_cell_mps), power, point.range, azimuth, rate,
                              config.range_sigma_m * errors[0], config.azimuth_sigma_rad * errors[1],
                              config.rate_sigma_mps * errors[2], objects[i].id, p});
    }
  }
  const auto cell = [](const RadarRoom::Echo& e) { return std::tuple(e.range_cell, e.azimuth_cell, e.rate_cell); };
  // The strongest echo of a cell is its first.
  std::sort(room.echoes_.begin(), room.echoes_.end(), [&](const RadarRoom::Echo& a, const RadarRoom::Echo& b) {
    return std::tuple(cell(a), -a.power, a.object, a.point) < std::tuple(cell(b), -b.power, b.object, b.point);
  });
  const auto full = [&] { return static_cast<int>(returns.size()) == config.max_returns; };
  for (std::size_t from = 0, to = 0; from < room.echoes_.size() && !full(); from = to) {
    const RadarRoom::Echo& strongest = room.echoes_[from];
    double power = 0.0, range = 0.0, azimuth = 0.0, rate = 0.0;
    for (; to < room.echoes_.size() && cell(room.echoes_[to]) == cell(strongest); ++to) {
      const RadarRoom::Echo& echo = room.echoes_[to];
      power += echo.power;
      range += echo.power * echo.range;
      azimuth += echo.power * echo.azimuth;
      rate += echo.power * echo.rate;
    }
    const double measured = range / power + strongest.range_noise + config.range_bias.fixed;
    if (measured <= 0.0) continue;
    returns.push_back({measured, azimuth / power + strongest.azimuth_noise + config.azimuth_bias.fixed,
                       folded(rate / power + strongest.rate_noise + config.rate_bias.fixed, config.rate_span_mps),
                       decibels(power)});
    truth.push_back(strongest.object);
  }
  RandomStream clutter(key.of(Purpose::kClutter));
  for (int n = poisson(clutter, config.clutter_per_list); n > 0 && !full(); --n) {
    const double range = clutter.uniform(1.0, config.max_range_m);
    const double azimuth = clutter.uniform(-config.half_field_rad, config.half_field_rad);
    const double rate = clutter.uniform(-0.5 * config.rate_span_mps, 0.5 * config.rate_span_mps);
    // The noise above the threshold.
    returns.push_back({range, azimuth, rate, decibels(threshold - std::log1p(-clutter.uniform()))});
    truth.push_back(ObjectId{0xffff});
  }
}

}  // namespace ttf::sensors::radar
