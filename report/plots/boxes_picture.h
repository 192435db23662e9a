// Laser scan points and the boxes fitted to them, in the plane (ISO 8855: x forward, y left, metres).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "report/drawing/svg.h"

namespace ttf::report::plots {

// A rectangle centred at (x, y), with `length` along `heading` (radians from x to y).
struct Box {
  double x = 0, y = 0, heading = 0, length = 0, width = 0;
  std::string label;  // may be empty
};

// Draws both axes in the same scale. The sensor is at the origin, if the origin lies in the picture.
std::string boxes_svg(std::span<const drawing::Point> points, std::span<const Box> boxes, std::string_view title);

}  // namespace ttf::report::plots
