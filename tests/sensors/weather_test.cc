// Weather and light, and the sides that a sensor's own vehicle hides.
#include "sim/world/weather.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sensors/laser/model.h"
#include "sensors/radar/model.h"
#include "sensors/stereo_camera/model.h"

namespace ttf::sensors {
namespace {

using testing::HasSubstr;

struct Read {
  sim::world::Weather weather;
  Device device;
  std::string refusal;
};
Read read(const std::string& text) {
  Read result;
  Findings findings;
  YamlMap root = StrictYaml::parse(text, "w.yaml").root(findings);
  result.weather = sim::world::load_weather(root);
  result.device = load_device(root);
  root.finish();
  try {
    findings.throw_if_any();
  } catch (const InputError& error) {
    result.refusal = error.what();
  }
  return result;
}

TEST(Weather, ClearChangesNothing) {
  const sim::world::Weather clear = read("weather: clear\n").weather;
  EXPECT_EQ(in_weather(laser::LaserConfig{}, clear).max_range_m, laser::LaserConfig{}.max_range_m);
  EXPECT_EQ(in_weather(laser::LaserConfig{}, clear).miss_at_100m, laser::LaserConfig{}.miss_at_100m);
  EXPECT_EQ(in_weather(stereo_camera::CameraConfig{}, clear).max_range_m, stereo_camera::CameraConfig{}.max_range_m);
  EXPECT_EQ(in_weather(stereo_camera::CameraConfig{}, clear).miss_probability,
            stereo_camera::CameraConfig{}.miss_probability);
  EXPECT_EQ(in_weather(radar::RadarConfig{}, clear).attenuation_db_per_km, 0.0);
}

TEST(Weather, EachKindHasItsOwnFactors) {
  const sim::world::Weather fog = read("weather: fog\n").weather, dark = read("weather: dark\n").weather,
                            rain = read("weather: rain\n").weather;
  EXPECT_DOUBLE_EQ(in_weather(laser::LaserConfig{}, fog).max_range_m, 48.0);
  EXPECT_DOUBLE_EQ(in_weather(laser::LaserConfig{}, dark).max_range_m, 120.0);
  EXPECT_DOUBLE_EQ(in_weather(stereo_camera::CameraConfig{}, dark).max_range_m, 54.0);
  EXPECT_DOUBLE_EQ(in_weather(stereo_camera::CameraConfig{}, dark).miss_probability, 0.1);
  EXPECT_DOUBLE_EQ(in_weather(radar::RadarConfig{}, rain).attenuation_db_per_km, 6.0);
  EXPECT_DOUBLE_EQ(in_weather(radar::RadarConfig{}, rain).clutter_per_list, 0.4);
  stereo_camera::CameraConfig blindfold;
  blindfold.miss_probability = 0.7;
  EXPECT_EQ(in_weather(blindfold, fog).miss_probability, 1.0);
}

TEST(Weather, AFactorReplacesThatOfTheName) {
  const sim::world::Weather weather =
      read("weather: rain\nweather_factors: {laser_range: 0.5, radar_attenuation: 20}\n").weather;
  EXPECT_EQ(weather.laser_range, 0.5);
  EXPECT_EQ(weather.radar_attenuation_db_per_km, 20.0);
  EXPECT_EQ(weather.camera_range, 0.75);
}

TEST(Weather, WrongOnesAreRefused) {
  EXPECT_THAT(read("weather: snow\n").refusal, HasSubstr("w.yaml:1: weather = snow: must be one of clear"));
  EXPECT_THAT(read("weather_factors: {laser_range: 2}\n").refusal, HasSubstr("weather_factors.laser_range = 2"));
}

TEST(BlindSides, HoldTheirAzimuthsInAllTurns) {
  const BlindSides blind = read("blind: [{from: 0.2, to: 0.4}, {from: 3.0, to: 3.3}]\n").device.blind;
  EXPECT_TRUE(blind.hold(0.3));
  EXPECT_FALSE(blind.hold(0.41));
  EXPECT_FALSE(blind.hold(-0.3));
  EXPECT_TRUE(blind.hold(-3.1)) << "behind, from the other side";
  EXPECT_FALSE(BlindSides{}.hold(0.0));
  EXPECT_THAT(read("blind: [{from: 0.4, to: 0.2}]\n").refusal, HasSubstr("blind[0].to = 0.2: must be above `from`"));
  EXPECT_THAT(
      read("blind: [{from: 0, to: 1}, {from: 0, to: 1}, {from: 0, to: 1}, {from: 0, to: 1}, {from: 0, to: 1}]\n")
          .refusal,
      HasSubstr("must have at most 4 sectors"));
}

TEST(BlindSides, NoSensorMeasuresThere) {
  ObjectState car;
  car.x = 30.0;
  car.y = 0.5;
  car.length = 4.4;
  car.width = 1.8;
  const std::vector<ObjectState> objects{car};
  // The right half of the car.
  BlindSides right, all;
  right.sectors[right.count++] = {-0.5, 0.0};
  all.sectors[all.count++] = {-0.5, 0.5};
  std::vector<ObjectId> truth;
  for (const BlindSides& blind : {right, all}) {
    const bool none = blind.sectors[0].to > 0.1;
    laser::LaserConfig laser;
    laser.device.blind = blind;
    std::vector<laser::HitPoint> hits;
    laser::measure_laser(laser, objects, {1, 0, 0, 0}, hits, truth);
    EXPECT_EQ(hits.empty(), none);
    EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](const laser::HitPoint& hit) { return hit.azimuth > 0.0; }));
    stereo_camera::CameraConfig camera;
    camera.miss_probability = camera.clutter_per_frame = 0.0;
    camera.device.blind = blind;
    stereo_camera::CameraRoom camera_room(1);
    std::vector<stereo_camera::CameraDetection> detections;
    stereo_camera::measure_camera(camera, objects, {1, 0, 0, 0}, camera_room, detections, truth);
    EXPECT_EQ(detections.empty(), none) << "its middle is to the left";
    radar::RadarConfig radar;
    radar.clutter_per_list = radar.azimuth_sigma_rad = 0.0;
    radar.snr_at_100m_db = 80.0;
    radar.device.blind = blind;
    radar::RadarRoom radar_room(1);
    std::vector<radar::RadarReturn> returns;
    radar::measure_radar(radar, objects, {}, {1, 0, 0, 0}, radar_room, returns, truth);
    EXPECT_EQ(returns.empty(), none);
    EXPECT_TRUE(
        std::all_of(returns.begin(), returns.end(), [](const radar::RadarReturn& one) { return one.azimuth > 0.0; }));
  }
}

}  // namespace
}  // namespace ttf::sensors
