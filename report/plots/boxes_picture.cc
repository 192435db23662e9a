#include "report/plots/boxes_picture.h"

#include <array>
#include <cmath>
#include <vector>

#include "report/drawing/axes.h"

namespace ttf::report {
namespace {

std::array<Point, 4> corners(const Box& b) {
  const double c = std::cos(b.heading), s = std::sin(b.heading);
  const auto at = [&](double u, double v) {
    return Point{b.x + c * u * b.length / 2 - s * v * b.width / 2, b.y + s * u * b.length / 2 + c * v * b.width / 2};
  };
  return {at(1, 1), at(-1, 1), at(-1, -1), at(1, -1)};
}

bool finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

}  // namespace

std::string boxes_svg(std::span<const Point> points, std::span<const Box> boxes, std::string_view title) {
  if (points.empty() && boxes.empty()) return empty_picture(title, "There are no points and no boxes to show.");
  Extent x, y;
  for (const Point& p : points) x.add(p.x), y.add(p.y);
  for (const Box& b : boxes)
    for (const Point& p : corners(b)) x.add(p.x), y.add(p.y);
  x = x.padded(0.04, 4);
  y = y.padded(0.06, 4);
  // One scale for both axes: the wider extent fills its side of at most 1100 x 760.
  const double scale = std::min(1100 / x.size(), 760 / y.size());
  const double width = std::max(420.0, x.size() * scale), height = std::max(200.0, y.size() * scale);
  x = x.padded(0, width / scale);
  y = y.padded(0, height / scale);

  const std::vector<LegendEntry> legend{
      {LegendEntry::Kind::kMarker, "scan point", std::string(kBlue), Marker::kCircle, true},
      {LegendEntry::Kind::kBox, "fitted box, arrow along its heading", std::string(kVermilion)},
      {LegendEntry::Kind::kMarker, "sensor", std::string(kBlack), Marker::kTriangle, true}};
  const double top = 34 + legend_height(legend, width) + 8;
  Svg svg(width + 90, top + height + 62, title);
  svg.text({70 + width / 2, 22}, title, {.size = 14, .anchor = Anchor::kMiddle, .bold = true});
  draw_legend(svg, {70, 34}, width, legend);
  const PlotFrame frame({70, top, width, height}, x, y);
  frame.draw(svg, "x, forward [m]", "y, left [m]");
  svg.open_group("points", frame.area());
  for (const Point& p : points)
    if (finite(p)) svg.marker(Marker::kCircle, frame.at(p.x, p.y), 2.4, {.fill = kBlue}, {}, "point");
  if (x.low <= 0 && x.high >= 0 && y.low <= 0 && y.high >= 0)
    svg.marker(Marker::kTriangle, frame.at(0, 0), 10, {.fill = kBlack}, "sensor");
  svg.close_group();
  LabelSpace labels;
  svg.open_group("boxes", frame.area());
  for (const Box& b : boxes) {
    std::vector<Point> outline;
    for (const Point& p : corners(b)) outline.push_back(frame.at(p.x, p.y));
    svg.polyline(outline, {.stroke = kVermilion, .width = 1.4}, true, b.label, "box");
    const Point centre = frame.at(b.x, b.y);
    const double reach = std::max(b.length / 2, 9.0 / scale);
    svg.arrow(centre, frame.at(b.x + std::cos(b.heading) * reach, b.y + std::sin(b.heading) * reach),
              {.stroke = kVermilion, .width = 1.0}, {}, "heading");
    if (b.label.empty()) continue;
    double above = centre.y, below = centre.y, right = centre.x;
    for (const Point& p : outline)
      above = std::min(above, p.y), below = std::max(below, p.y), right = std::max(right, p.x);
    const TextStyle style{.size = 10, .anchor = Anchor::kMiddle, .halo = true};
    const double half = text_width(b.label, 10) / 2;
    const std::array<Point, 3> candidates{Point{centre.x, above - 4}, Point{centre.x, below + 12},
                                          Point{right + 6 + half, centre.y + 4}};
    if (const auto p = labels.place(b.label, style, candidates, frame.area())) svg.text(*p, b.label, style);
  }
  svg.close_group();
  svg.text({70, top + height + 54},
           "Coordinates follow ISO 8855: x forward, y to the left; both axes in the same scale.",
           {.size = 10, .fill = "#444444"});
  return svg.str();
}

}  // namespace ttf::report
