// Plain terms for the parts of a scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ttf::recording::exports::viewer {

// Red, green, blue and opacity, each 0..1.
struct Colour {
  double r = 1.0, g = 1.0, b = 1.0, a = 1.0;
};
// Returns the colour of "#d55e00"; white for other texts.
Colour colour_of(std::string_view text);
constexpr Colour with_opacity(Colour colour, double a) { return {colour.r, colour.g, colour.b, a}; }

struct Point {
  double x = 0.0, y = 0.0;  // [m]
};
struct Place {
  double x = 0.0, y = 0.0, heading = 0.0;  // [m], [rad] from x to y
};

// The part of the plane that a sensor sees, in its own axes.
struct ViewedField {
  double half_angle = 0.0;                    // [rad] to either side of the sensor's axis
  double min_range = 0.0, max_range = 100.0;  // [m]
};
struct ViewedSensor {
  std::string name;
  Colour colour;
  std::optional<Place> mounting;     // on the vehicle; absent: unknown
  std::optional<ViewedField> field;  // absent: unknown
};

}  // namespace ttf::recording::exports::viewer
