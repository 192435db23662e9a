// How pictures show a sensor, in words. A log has the words of its scenario, and the report's palette has their
// values (report/drawing/names.h).
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace ttf::recording::log {

// Circles, squares and black are left to the reference and the fusion.
inline constexpr std::array<std::string_view, 7> kSensorColours{"vermilion", "blue",   "green", "orange",
                                                                "sky_blue",  "purple", "grey"};
inline constexpr std::array<std::string_view, 5> kSensorMarkers{"cross", "plus", "triangle", "down_triangle",
                                                                "diamond"};

// Each word may be empty. Then pictures take the sensor's kind from its name, and colour and marker from its kind.
struct SensorStyle {
  std::string kind;    // "laser", "camera"
  std::string colour;  // of kSensorColours
  std::string marker;  // of kSensorMarkers

  bool operator==(const SensorStyle&) const = default;
};

}  // namespace ttf::recording::log
