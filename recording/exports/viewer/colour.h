// Colours of a scene.
#pragma once

#include <string_view>

namespace ttf::recording::exports::viewer {

// Red, green, blue and opacity, each 0..1.
struct Colour {
  double r = 1.0, g = 1.0, b = 1.0, a = 1.0;
};
// Returns the colour of "#d55e00"; white for other texts.
Colour colour_of(std::string_view text);
constexpr Colour with_opacity(Colour colour, double a) { return {colour.r, colour.g, colour.b, a}; }

}  // namespace ttf::recording::exports::viewer
