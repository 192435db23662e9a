// A small SVG writer: shapes, text, groups and arrows in painting order.
//
// Coordinates and sizes are SVG user units, y down. Numbers have at most two decimals, so equal input gives
// equal bytes. The advance widths of DejaVu Sans, the pictures' font, measure text: layout avoids overlaps
// without a renderer.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/drawing/sheet.h"

namespace ttf::report::drawing {

struct Point {
  double x = 0, y = 0;
};

struct Area {
  double x = 0, y = 0, width = 0, height = 0;
  bool overlaps(const Area& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

// Returns at most two decimals, without trailing zeros or "-0".
std::string number(double value);
// Escapes & < > " and control characters for XML.
std::string escape(std::string_view text);
// Returns the width of one line of UTF-8 in DejaVu Sans at `size`.
double text_width(std::string_view text, double size, bool bold = false);

struct Paint {
  std::string_view fill = "none";
  std::string_view stroke = "none";
  double width = 1.0;
  std::string_view dash = {};  // as stroke-dasharray, e.g. "4 3"
  double opacity = 1.0;
};

enum class Anchor : std::uint8_t { kStart, kMiddle, kEnd };

struct TextStyle {
  double size = 11;
  Anchor anchor = Anchor::kStart;
  std::string_view fill = "#000000";
  bool bold = false;
  double rotate = 0;  // degrees clockwise about the anchor point
  bool halo = false;  // white outline, for text over lines
};

// Returns the area of a text drawn unrotated at `at`, which lies on the baseline.
Area text_area(Point at, std::string_view text, const TextStyle& style);

// The distance of lines of text.
inline constexpr double kLineHeight = 14;

enum class Marker : std::uint8_t { kCircle, kCross, kTriangle, kSquare, kDiamond, kDownTriangle, kPlus };

// A marker's lines about its place, in halves of its size, y down. A circle has none.
struct MarkerShape {
  std::vector<std::vector<Point>> lines;
  bool closed = true;
};
MarkerShape shape_of(Marker kind);

class Svg {
 public:
  // On paper all text has one size, whatever its style says, and the picture its size in millimetres.
  Svg(double width, double height, std::string_view title, const Sheet& sheet = {});

  double width() const { return width_; }
  double height() const { return height_; }

  void open_group(std::string_view css_class);
  // Opens a group that is visible only inside `clip`.
  void open_group(std::string_view css_class, const Area& clip);
  void close_group();

  // `hover` becomes the shape's <title>.
  void rect(const Area& area, const Paint& paint, std::string_view hover = {}, std::string_view css_class = {});
  void line(Point a, Point b, const Paint& paint, std::string_view css_class = {});
  void polyline(std::span<const Point> points, const Paint& paint, bool closed = false, std::string_view hover = {},
                std::string_view css_class = {});
  void arrow(Point a, Point b, const Paint& paint, std::string_view hover = {}, std::string_view css_class = "arrow");
  void marker(Marker kind, Point at, double size, const Paint& paint, std::string_view hover = {},
              std::string_view css_class = {});
  void text(Point at, std::string_view text, const TextStyle& style = {});
  // Draws lines of text, the first at `at`.
  void lines(Point at, std::span<const std::string> lines, const TextStyle& style = {});

  // Adds attributes to the next element, verbatim (" data-a=\"12\""): for scripts.
  void tag_next(std::string attributes) { tags_ = std::move(attributes); }

  std::string str() const;

 private:
  void finish_element(std::string_view name, std::string_view hover);

  double width_, height_;
  std::string title_;
  Sheet sheet_;
  std::string defs_;
  std::string body_, tags_;
  std::set<std::string, std::less<>> heads_;  // colours with a defined arrow head
  int clips_ = 0;
};

}  // namespace ttf::report::drawing
