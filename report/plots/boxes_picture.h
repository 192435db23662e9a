// Laser scan points and the boxes fitted to them, in the plane (ISO 8855: x forward, y left, metres).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "report/drawing/svg.h"

namespace ttf::report::plots {

// A rectangle centred at (x, y), with `length` along `heading` (radians from x to y). Without a known heading it is drawn
// as its place alone. A box whose size is supposed, not measured, is dashed.
struct Box {
  double x = 0, y = 0, heading = 0, length = 0, width = 0;
  std::string label;  // may be empty
  bool has_heading = true, has_size = true;
};

// Draws both axes in the same scale. The sensor is at the origin, if the origin lies in the picture. `words` name the
// boxes in the legend.
std::string boxes_svg(std::span<const drawing::Point> points, std::span<const Box> boxes, std::string_view title,
                      std::string_view words = "fitted box", const drawing::Sheet& sheet = {});

}  // namespace ttf::report::plots
