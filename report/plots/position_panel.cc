// Draws the parts of report/plots/position_panel.h: markers, numbered instants and arrows.
#include "report/plots/position_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace ttf::report::plots {
namespace {

using Sample = PositionPlots::Sample;
using Selection = PositionPlots::Selection;

constexpr double kMarker = 7, kLeastMarker = 2.5;
constexpr std::string_view kReference = drawing::kPurple, kFusion = drawing::kBlack, kTruth = "#777777",
                           kUnused = "#a0a0a0";
template <class Visit> void every_sample(const Selection& s, const Visit& visit) {
  for (const auto* list : {&s.truth, &s.reference, &s.fusion, &s.unused})
    for (const Sample& sample : *list) visit(sample);
  for (const auto& list : s.observations)
    for (const Sample& sample : list) visit(sample);
  for (const auto& arrow : s.laser_arrows) visit(arrow.measured), visit(arrow.fused);
  for (const auto& instant : s.instants) visit(instant.at);
}

void boxed_number(drawing::Svg& svg, drawing::Point centre, const std::string& text, double size) {
  const double w = drawing::text_width(text, size) + 5;
  svg.rect({centre.x - w / 2, centre.y - size / 2 - 2, w, size + 4},
           {.fill = "#ffffff", .stroke = drawing::kBlack, .width = 0.7}, {}, "instant");
  svg.text({centre.x, centre.y + 0.36 * size}, text, {.size = size, .anchor = drawing::Anchor::kMiddle});
}

// Returns instants with a laser measurement first: their numbers matter most if space is short.
std::vector<const PositionPlots::Instant*> by_importance(const Selection& s) {
  std::vector<const PositionPlots::Instant*> order;
  for (const auto& i : s.instants) order.push_back(&i);
  std::stable_partition(order.begin(), order.end(), [](const auto* i) { return i->laser; });
  return order;
}

// Over time, the numbers stand in a row above the panel, each with a thin line through it. In the plane, they
// stand beside the fused position, with a leader.
void draw_instants(drawing::Svg& svg, const drawing::PlotFrame& frame, const Selection& s, PositionView view,
                   bool numbers, double size) {
  const drawing::Area& area = frame.area();
  drawing::LabelSpace space;
  const auto box_around = [&](drawing::Point c, const std::string& text) {
    const double w = drawing::text_width(text, size) + 8;
    return drawing::Area{c.x - w / 2, c.y - 8, w, std::max(16.0, size + 5)};
  };
  if (over_time(view)) {
    for (const auto* i : by_importance(s)) {
      const drawing::Point p = frame.at(i->at.t, 0);
      const std::string text = fmt::format("{}", i->step);
      const drawing::Point centre{p.x, area.y - kStrip / 2 - 1};
      const drawing::Area box = box_around(centre, text);
      const bool shown =
          numbers && box.x >= area.x - 10 && box.x + box.width <= area.x + area.width + 10 && space.claim(box);
      svg.line({p.x, area.y - (shown ? 4.0 : 0.0)}, {p.x, area.y + area.height},
               {.stroke = i->laser ? "#c4c4c4" : "#e4e4e4", .width = 0.7}, "instant-line");
      if (shown) boxed_number(svg, centre, text, size);
    }
    return;
  }
  every_sample(s, [&](const Sample& sample) {
    const drawing::Point p = frame.at(coordinates(sample, view).x, coordinates(sample, view).y);
    space.take({p.x - 4, p.y - 4, 8, 8});
  });
  for (const auto& a : s.laser_arrows)
    for (int k = 1; k < 8; ++k) {
      const drawing::Point p = frame.at(a.measured.x + (a.fused.x - a.measured.x) * k / 8,
                                        a.measured.y + (a.fused.y - a.measured.y) * k / 8);
      space.take({p.x - 2, p.y - 2, 4, 4});
    }
  for (const auto* i : by_importance(s)) {
    const drawing::Point p = frame.at(i->at.x, i->at.y);
    const std::string text = fmt::format("{}", i->step);
    for (const double reach : {26.0, 40.0, 56.0, 74.0}) {
      if (!i->laser && reach > 40) break;  // in a crowd, only the arrows' instants get numbers
      bool done = false;
      for (const drawing::Point d : {drawing::Point{0, -1}, drawing::Point{0, 1}, drawing::Point{0.7, -0.7},
                                     drawing::Point{-0.7, -0.7}, drawing::Point{0.7, 0.7}, drawing::Point{-0.7, 0.7}}) {
        const drawing::Point c{p.x + reach * d.x, p.y + reach * d.y};
        const drawing::Area box = box_around(c, text);
        if (box.x < area.x || box.y < area.y || box.x + box.width > area.x + area.width ||
            box.y + box.height > area.y + area.height)
          continue;
        if (!space.claim(box)) continue;
        svg.line(p, c, {.stroke = "#9a9a9a", .width = 0.6}, "leader");
        svg.marker(drawing::Marker::kCircle, p, 2.6, {.fill = drawing::kBlack}, {}, "fused-at");
        boxed_number(svg, c, text, size);
        done = true;
        break;
      }
      if (done) break;
    }
  }
}

// Returns the size of the markers of a row of points. In a small picture they shrink rather than cover each other.
double marker_size(const std::vector<drawing::Point>& row) {
  if (row.size() < 2) return kMarker;
  std::vector<double> apart;
  for (std::size_t i = 1; i < row.size(); ++i)
    apart.push_back(std::hypot(row[i].x - row[i - 1].x, row[i].y - row[i - 1].y));
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::ranges::nth_element(apart, middle);
  return std::clamp(0.85 * *middle, kLeastMarker, kMarker);
}

void draw_data(drawing::Svg& svg, const drawing::PlotFrame& frame, const Selection& s, const drawing::Names& names,
               PositionView view) {
  const auto at = [&](const Sample& sample) {
    const drawing::Point p = coordinates(sample, view);
    return frame.at(p.x, p.y);
  };
  std::vector<drawing::Point> line;
  for (const Sample& sample : s.truth) line.push_back(at(sample));
  svg.open_group("data", frame.area());
  svg.polyline(line, {.stroke = kTruth, .width = 1.0}, false, "truth", "truth");
  std::map<SensorId, std::string> colours;
  for (const auto& a : s.laser_arrows) {
    std::string& colour = colours[a.measured.id.sensor];
    if (colour.empty()) colour = sensor_colour(names, a.measured.id.sensor);
    svg.arrow(
        at(a.measured), at(a.fused), {.stroke = colour, .width = 0.9, .dash = a.late ? "5 3" : ""},
        fmt::format("{} #{}{}", names.sensor(a.measured.id.sensor), a.measured.id.sequence, a.late ? ", late" : ""),
        a.late ? "arrow late" : "arrow");
  }
  const auto hover = [](const std::string& what, const Sample& v) {
    return fmt::format("{}: t {:.4f} s, x {:.2f} m, y {:.2f} m", what, v.t, v.x, v.y);
  };
  const auto size_of = [&](const std::vector<Sample>& row) {
    std::vector<drawing::Point> points;
    for (const Sample& v : row) points.push_back(at(v));
    return marker_size(points);
  };
  for (const Sample& v : s.reference)
    svg.marker(drawing::Marker::kCircle, at(v), kMarker, {.stroke = kReference, .width = 1.3}, hover("dgps", v),
               "dgps");
  for (std::size_t i = 0; i < s.observations.size(); ++i) {
    const SensorId id{static_cast<std::uint8_t>(i)};
    const std::string colour = sensor_colour(names, id), name = names.sensor(id);
    const drawing::Marker marker = sensor_marker(names, id);
    const double size = size_of(s.observations[i]);
    for (const Sample& v : s.observations[i])
      svg.marker(marker, at(v), size, {.stroke = colour, .width = 1.3},
                 hover(fmt::format("{} #{}", name, v.id.sequence), v), "observation");
  }
  for (const Sample& v : s.unused)
    svg.marker(drawing::Marker::kSquare, at(v), kMarker, {.stroke = kUnused, .width = 1.0}, hover("unused image", v),
               "unused");
  const double size = size_of(s.fusion);
  for (const Sample& v : s.fusion)
    svg.marker(drawing::Marker::kSquare, at(v), size, {.stroke = kFusion, .width = 1.3}, hover("fusion", v), "fusion");
  svg.close_group();
}

}  // namespace

drawing::Point coordinates(const Sample& s, PositionView view) {
  switch (view) {
    case PositionView::kXOverTime: return {s.t, s.x};
    case PositionView::kYOverTime: return {s.t, s.y};
    case PositionView::kPlane: break;
  }
  return {s.x, s.y};
}

std::string_view y_label(PositionView view) {
  return view == PositionView::kXOverTime ? "x, forward [m]" : "y, left [m]";
}
std::string_view x_label(PositionView view) { return over_time(view) ? "true time [s]" : "x, forward [m]"; }

Extents padded(Extents e, PositionView view) {
  e.x = over_time(view) ? e.x.padded(0.015, 0.01) : e.x.padded(0.04, 0.5);
  e.y = e.y.padded(0.07, 0.5);
  return e;
}

Extents extents_of(std::span<const Selection> selections, PositionView view) {
  return extents_of(selections, view, [](const Selection& s, const auto& visit) { every_sample(s, visit); });
}

std::vector<drawing::LegendEntry> legend_of(std::span<const Selection> selections, const drawing::Names& names) {
  using K = drawing::LegendEntry::Kind;
  const auto any = [&](auto list) {
    return std::ranges::any_of(selections, [&](const Selection& s) { return !(s.*list).empty(); });
  };
  std::vector<drawing::LegendEntry> legend;
  if (any(&Selection::reference))
    legend.push_back({K::kMarker, "dgps", std::string(kReference), drawing::Marker::kCircle});
  std::size_t sensors = 0;
  for (const Selection& s : selections) sensors = std::max(sensors, s.observations.size());
  for (std::size_t i = 0; i < sensors; ++i) {
    const SensorId id{static_cast<std::uint8_t>(i)};
    if (std::ranges::any_of(
            selections, [&](const Selection& s) { return i < s.observations.size() && !s.observations[i].empty(); }))
      legend.push_back({K::kMarker, names.sensor(id), sensor_colour(names, id), sensor_marker(names, id)});
  }
  if (any(&Selection::fusion))
    legend.push_back(
        {K::kMarker, "fusion (image at its instant of use)", std::string(kFusion), drawing::Marker::kSquare});
  if (any(&Selection::unused))
    legend.push_back({K::kMarker, "unused image", std::string(kUnused), drawing::Marker::kSquare});
  if (any(&Selection::truth)) legend.push_back({K::kLine, "truth", std::string(kTruth)});
  if (any(&Selection::instants)) legend.push_back({K::kNumber, "fusion instant", std::string(drawing::kBlack)});
  const auto late = [](const auto& a) { return a.late; };
  const bool any_late =
      std::ranges::any_of(selections, [&](const Selection& s) { return std::ranges::any_of(s.laser_arrows, late); });
  std::set<SensorId> lasers;
  for (const Selection& s : selections)
    for (const auto& a : s.laser_arrows) lasers.insert(a.measured.id.sensor);
  for (const SensorId id : lasers)
    legend.push_back({K::kArrow, (lasers.size() == 1 ? "laser" : names.sensor(id)) + " measurement to its integration",
                      sensor_colour(names, id)});
  if (any_late)
    legend.push_back({K::kArrow, "the same, late", sensor_colour(names, *lasers.begin()), {}, false, "5 3"});
  return legend;
}

void draw_panel(drawing::Svg& svg, const drawing::PlotFrame& frame, const Selection& s, const drawing::Names& names,
                PositionView view, bool with_x, bool numbers, const drawing::Sheet& sheet) {
  frame.draw(svg, with_x ? x_label(view) : "", y_label(view));
  // In the plane, the data lie above the leaders; over time, above the thin lines.
  draw_instants(svg, frame, s, view, numbers, sheet.text(8.5));
  draw_data(svg, frame, s, names, view);
}

}  // namespace ttf::report::plots
