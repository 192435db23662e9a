// Shared parts of plots: extents, ticks, scales, a frame with labels and units, a legend beside the data, a
// palette for colour-blind readers, and the space that labels take up so that they do not overlap.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/drawing/svg.h"

namespace ttf::report::drawing {

// Source: M. Okabe, K. Ito: Color Universal Design (2008).
inline constexpr std::string_view kBlack = "#000000", kOrange = "#e69f00", kSkyBlue = "#56b4e9", kGreen = "#009e73",
                                  kYellow = "#f0e442", kBlue = "#0072b2", kVermilion = "#d55e00", kPurple = "#cc79a7",
                                  kGrey = "#8c8c8c", kStatusFrame = "#a8a8a8";
// Returns the i-th colour for things without a colour of their own; lighter tints follow at the palette's end.
std::string palette(std::size_t i);
// Returns `colour` ("#rrggbb") mixed with white: amount 0 is the colour itself, 1 is white.
std::string tint(std::string_view colour, double amount);
// Returns `colour` mixed with black: amount 0 is the colour itself, 1 is black.
std::string darker(std::string_view colour, double amount);
// Returns black or white, the better readable one on `colour`.
std::string_view text_colour_on(std::string_view colour);

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double v);  // ignores values that are not finite
  void add(const Extent& other);
  bool empty() const { return low > high; }
  double size() const { return high - low; }
  // Returns the extent widened by `fraction` on each side, at least `least` wide; 0..1 if empty.
  Extent padded(double fraction, double least) const;
};

// Multiples of 1, 2 or 5 times a power of ten inside the extent, about `about` many.
struct Ticks {
  double step = 1;
  std::vector<double> at;
};
Ticks nice_ticks(const Extent& extent, int about);
// Returns ticks that are more than `about` where that gives fewer than three. `fits` says whether their labels have room.
Ticks readable_ticks(const Extent& extent, int about, const std::function<bool(const Ticks&)>& fits);
// Returns the value with as many decimals as the step needs.
std::string tick_label(double value, double step);

// A linear map from data to the page.
struct Scale {
  Extent data;
  double from = 0, to = 1;
  double operator()(double v) const { return from + (v - data.low) / data.size() * (to - from); }
};

// A rectangle with ticks, grid and axis labels. `area` is the inner rectangle; the labels are below and to its left.
class PlotFrame {
 public:
  PlotFrame(const Area& area, const Extent& x, const Extent& y);
  Point at(double x, double y) const { return {x_(x), y_(y)}; }
  const Area& area() const { return area_; }
  const Extent& x_extent() const { return x_.data; }
  const Extent& y_extent() const { return y_.data; }
  // Draws grid and frame. An empty x label also omits the x ticks' numbers, for panels above a common axis.
  void draw(Svg& svg, std::string_view x_label, std::string_view y_label) const;

 private:
  Area area_;
  Scale x_, y_;
};

// Draws ticks and numbers below `plot`, which shows the time window of true time [ms] from left to right.
void draw_time_axis(Svg& svg, const Area& plot, const Extent& window_ms);

// The areas already taken. claim() takes an area only if it is free.
class LabelSpace {
 public:
  bool claim(const Area& area);
  void take(const Area& area) { taken_.push_back(area); }
  // Returns the first candidate anchor point at which the text is free and inside `bounds`.
  std::optional<Point> place(std::string_view text, const TextStyle& style, std::span<const Point> candidates,
                             const Area& bounds);

 private:
  std::vector<Area> taken_;
};

// A legend entry: a marker, a line, a box, an arrow or a boxed number, and its meaning.
struct LegendEntry {
  enum class Kind : std::uint8_t { kMarker, kLine, kBox, kArrow, kNumber };
  Kind kind = Kind::kMarker;
  std::string text;
  std::string colour;
  Marker marker = Marker::kCircle;
  bool filled = false;
  std::string dash = {};
  double width = 1.5;  // of a line
};
// Entries run in rows from left to right, wrapped at `width`. A longer entry has several lines. The legend has its own space beside the plot
// and never covers data.
double legend_height(std::span<const LegendEntry> entries, double width);
void draw_legend(Svg& svg, Point top_left, double width, std::span<const LegendEntry> entries);

// Returns a picture that says why it is empty.
std::string empty_picture(std::string_view title, std::string_view reason, const Sheet& sheet = {});

}  // namespace ttf::report::drawing
