#include "sim/world/weather.h"

namespace ttf::sim::world {
namespace {

constexpr Weather kInTheClear{};
constexpr Weather kInRain{.laser_range = 0.75,
                          .laser_misses = 2.0,
                          .camera_range = 0.75,
                          .camera_misses = 2.0,
                          .camera_clutter = 2.0,
                          .radar_attenuation_db_per_km = 6.0,
                          .radar_clutter = 2.0};
constexpr Weather kInFog{.laser_range = 0.4,
                         .laser_misses = 3.0,
                         .camera_range = 0.4,
                         .camera_misses = 3.0,
                         .radar_attenuation_db_per_km = 0.2};
constexpr Weather kInTheDark{.camera_range = 0.6, .camera_misses = 2.0, .camera_clutter = 2.0};

enum class Kind : unsigned char { kClear, kRain, kFog, kDark };

const Weather& weather_of(Kind kind) {
  switch (kind) {
    case Kind::kClear: return kInTheClear;
    case Kind::kRain: return kInRain;
    case Kind::kFog: return kInFog;
    case Kind::kDark: break;
  }
  return kInTheDark;
}

}  // namespace

Weather load_weather(YamlMap& world) {
  Weather weather = weather_of(world.choice_or<Kind>(
      "weather", Kind::kClear,
      {{"clear", Kind::kClear}, {"rain", Kind::kRain}, {"fog", Kind::kFog}, {"dark", Kind::kDark}}));
  if (auto factors = world.map_if("weather_factors")) {
    constexpr Range<double> kShare{0.01, 1.0}, kMore{0.0, 100.0};
    // Absent factors are the weather's, so that they have no default of their own.
    const auto read = [&](const char* key, double& factor, Range<double> allowed, const char* unit = "") {
      if (factors->has(key)) factor = factors->number(key, allowed, unit);
    };
    read("laser_range", weather.laser_range, kShare);
    read("laser_misses", weather.laser_misses, kMore);
    read("camera_range", weather.camera_range, kShare);
    read("camera_misses", weather.camera_misses, kMore);
    read("camera_clutter", weather.camera_clutter, kMore);
    read("radar_attenuation", weather.radar_attenuation_db_per_km, kMore, "dB/km");
    read("radar_clutter", weather.radar_clutter, kMore);
    factors->finish();
  }
  return weather;
}

}  // namespace ttf::sim::world
