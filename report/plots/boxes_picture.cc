#include "report/plots/boxes_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "report/drawing/axes.h"

namespace ttf::report::plots {
namespace {

std::array<drawing::Point, 4> corners(const Box& b) {
  const double c = std::cos(b.heading), s = std::sin(b.heading);
  const auto at = [&](double u, double v) {
    return drawing::Point{b.x + c * u * b.length / 2 - s * v * b.width / 2,
                          b.y + s * u * b.length / 2 + c * v * b.width / 2};
  };
  return {at(1, 1), at(-1, 1), at(-1, -1), at(1, -1)};
}

bool finite(drawing::Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

}  // namespace

std::string boxes_svg(std::span<const drawing::Point> points, std::span<const Box> boxes, std::string_view title,
                      std::string_view words, const drawing::Sheet& sheet) {
  if (points.empty() && boxes.empty())
    return drawing::empty_picture(title, "There are no points and no boxes to show.", sheet);
  drawing::Extent x, y;
  for (const drawing::Point& p : points) x.add(p.x), y.add(p.y);
  for (const Box& b : boxes) {
    x.add(b.x), y.add(b.y);
    if (!b.has_heading) continue;
    for (const drawing::Point& p : corners(b)) x.add(p.x), y.add(p.y);
  }
  x = x.padded(0.04, 4);
  y = y.padded(0.06, 4);
  // Both axes share one scale: the wider extent fills its side of at most 1100 x 760 on a screen.
  const double widest = sheet.plot_width(1100, 90), highest = sheet.on_paper() ? 0.8 * widest : 760;
  const double scale = std::min(widest / x.size(), highest / y.size());
  const double width = sheet.on_paper() ? widest : std::max(420.0, x.size() * scale);
  const double height = std::max(sheet.on_paper() ? 90.0 : 200.0, y.size() * scale);
  x = x.padded(0, width / scale);
  y = y.padded(0, height / scale);

  const auto any = [&](auto is) { return std::any_of(boxes.begin(), boxes.end(), is); };
  std::vector<drawing::LegendEntry> legend{
      {drawing::LegendEntry::Kind::kMarker, "scan point", std::string(drawing::kBlue), drawing::Marker::kCircle, true},
      {drawing::LegendEntry::Kind::kBox, fmt::format("{}, arrow along its heading", words),
       std::string(drawing::kVermilion)},
      {drawing::LegendEntry::Kind::kMarker, "sensor", std::string(drawing::kBlack), drawing::Marker::kTriangle, true}};
  if (any([](const Box& b) { return !b.has_heading; }))
    legend.push_back({drawing::LegendEntry::Kind::kMarker, "its heading is not known", std::string(drawing::kVermilion),
                      drawing::Marker::kDiamond, true});
  if (any([](const Box& b) { return b.has_heading && !b.has_size; }))
    legend.push_back(
        {drawing::LegendEntry::Kind::kBox, "dashed: the size is not measured", std::string(drawing::kVermilion)});
  const double left = sheet.on_paper() ? 10 : 70, words_width = 70 + width - left;
  const std::vector<std::string> titles = drawing::broken(title, sheet.text(14), sheet.line(words_width), true);
  const std::vector<std::string> caption =
      drawing::broken("Coordinates follow ISO 8855: x forward, y to the left; both axes in the same scale.",
                      sheet.text(10), sheet.line(words_width));
  const double legend_top = 34 + drawing::kLineHeight * static_cast<double>(titles.size() - 1);
  const double top = legend_top + legend_height(legend, words_width) + 8;
  drawing::Svg svg(width + 90, top + height + 62 + drawing::kLineHeight * static_cast<double>(caption.size() - 1),
                   title, sheet);
  svg.lines({left + words_width / 2, 22}, titles, {.size = 14, .anchor = drawing::Anchor::kMiddle, .bold = true});
  draw_legend(svg, {left, legend_top}, words_width, legend);
  const drawing::PlotFrame frame({70, top, width, height}, x, y);
  frame.draw(svg, "x, forward [m]", "y, left [m]");
  svg.open_group("points", frame.area());
  for (const drawing::Point& p : points)
    if (finite(p)) svg.marker(drawing::Marker::kCircle, frame.at(p.x, p.y), 2.4, {.fill = drawing::kBlue}, {}, "point");
  if (x.low <= 0 && x.high >= 0 && y.low <= 0 && y.high >= 0)
    svg.marker(drawing::Marker::kTriangle, frame.at(0, 0), 10, {.fill = drawing::kBlack}, "sensor");
  svg.close_group();
  drawing::LabelSpace labels;
  svg.open_group("boxes", frame.area());
  for (const Box& b : boxes) {
    std::vector<drawing::Point> outline;
    for (const drawing::Point& p : corners(b)) outline.push_back(frame.at(p.x, p.y));
    const drawing::Point centre = frame.at(b.x, b.y);
    if (b.has_heading) {
      const drawing::Paint paint{
          .stroke = drawing::kVermilion, .width = 1.4, .dash = b.has_size ? std::string_view() : "4 3"};
      svg.polyline(outline, paint, true, b.label, "box");
      const double reach = std::max(b.length / 2, 9.0 / scale);
      svg.arrow(centre, frame.at(b.x + std::cos(b.heading) * reach, b.y + std::sin(b.heading) * reach),
                {.stroke = drawing::kVermilion, .width = 1.0}, {}, "heading");
    } else {
      outline.assign({centre});
      svg.marker(drawing::Marker::kDiamond, centre, 9, {.fill = drawing::kVermilion}, b.label, "place");
    }
    if (b.label.empty()) continue;
    double above = centre.y, below = centre.y, right = centre.x;
    for (const drawing::Point& p : outline)
      above = std::min(above, p.y), below = std::max(below, p.y), right = std::max(right, p.x);
    const drawing::TextStyle style{.size = sheet.text(10), .anchor = drawing::Anchor::kMiddle, .halo = true};
    const double half = drawing::text_width(b.label, style.size) / 2;
    const std::array<drawing::Point, 3> candidates{drawing::Point{centre.x, above - 4},
                                                   drawing::Point{centre.x, below + 12},
                                                   drawing::Point{right + 6 + half, centre.y + 4}};
    if (const auto p = labels.place(b.label, style, candidates, frame.area())) svg.text(*p, b.label, style);
  }
  svg.close_group();
  svg.lines({left, top + height + 54}, caption, {.size = 10, .fill = "#444444"});
  return svg.str();
}

}  // namespace ttf::report::plots
