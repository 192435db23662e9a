// Draws report/plots/position_plot.h: panels, markers, numbered instants and arrows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/check.h"
#include "report/drawing/axes.h"
#include "report/plots/position_plot.h"

namespace ttf::report::plots {
namespace {

using Sample = PositionPlots::Sample;
using Selection = PositionPlots::Selection;

constexpr double kLeft = 70, kMarker = 7;
constexpr std::string_view kReference = drawing::kPurple, kFusion = drawing::kBlack, kTruth = "#777777",
                           kUnused = "#a0a0a0";
constexpr std::string_view kCaption =
    "Axes follow ISO 8855 (x forward, y to the left of the sensor vehicle); the paper draws y forward and x "
    "sideways.";

bool over_time(PositionView view) { return view != PositionView::kPlane; }

drawing::Point coordinates(const Sample& s, PositionView view) {
  switch (view) {
    case PositionView::kXOverTime: return {s.t, s.x};
    case PositionView::kYOverTime: return {s.t, s.y};
    case PositionView::kPlane: break;
  }
  return {s.x, s.y};
}

template <class Visit> void every_sample(const Selection& s, const Visit& visit) {
  for (const auto* list : {&s.truth, &s.reference, &s.fusion, &s.unused})
    for (const Sample& sample : *list) visit(sample);
  for (const auto& list : s.observations)
    for (const Sample& sample : list) visit(sample);
  for (const auto& arrow : s.laser_arrows) visit(arrow.measured), visit(arrow.fused);
  for (const auto& instant : s.instants) visit(instant.at);
}

struct Extents {
  drawing::Extent x, y;
};

Extents extents_of(std::span<const Selection> selections, PositionView view) {
  Extents e;
  for (const Selection& s : selections)
    every_sample(s, [&](const Sample& sample) {
      const drawing::Point p = coordinates(sample, view);
      e.x.add(p.x);
      e.y.add(p.y);
    });
  e.x = over_time(view) ? e.x.padded(0.015, 0.01) : e.x.padded(0.04, 0.5);
  e.y = e.y.padded(0.07, 0.5);
  return e;
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

constexpr double kStrip = 20;  // the row of numbered instants above a panel over time

// Over time, the numbers stand in a row above the panel, each with a thin line through it. In the plane, they
// stand beside the fused position, with a leader.
void draw_instants(drawing::Svg& svg, const drawing::PlotFrame& frame, const Selection& s, PositionView view,
                   bool numbers) {
  const drawing::Area& area = frame.area();
  drawing::LabelSpace space;
  constexpr double kSize = 8.5;
  const auto box_around = [&](drawing::Point c, const std::string& text) {
    const double w = drawing::text_width(text, kSize) + 8;
    return drawing::Area{c.x - w / 2, c.y - 8, w, 16};
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
      if (shown) boxed_number(svg, centre, text, kSize);
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
        boxed_number(svg, c, text, kSize);
        done = true;
        break;
      }
      if (done) break;
    }
  }
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
  for (const Sample& v : s.reference)
    svg.marker(drawing::Marker::kCircle, at(v), kMarker, {.stroke = kReference, .width = 1.3}, hover("dgps", v),
               "dgps");
  for (std::size_t i = 0; i < s.observations.size(); ++i) {
    const SensorId id{static_cast<std::uint8_t>(i)};
    const std::string colour = sensor_colour(names, id), name = names.sensor(id);
    const drawing::Marker marker = sensor_marker(names, id);
    for (const Sample& v : s.observations[i])
      svg.marker(marker, at(v), kMarker, {.stroke = colour, .width = 1.3},
                 hover(fmt::format("{} #{}", name, v.id.sequence), v), "observation");
  }
  for (const Sample& v : s.unused)
    svg.marker(drawing::Marker::kSquare, at(v), kMarker, {.stroke = kUnused, .width = 1.0}, hover("unused image", v),
               "unused");
  for (const Sample& v : s.fusion)
    svg.marker(drawing::Marker::kSquare, at(v), kMarker, {.stroke = kFusion, .width = 1.3}, hover("fusion", v),
               "fusion");
  svg.close_group();
}

std::string_view y_label(PositionView view) {
  return view == PositionView::kXOverTime ? "x, forward [m]" : "y, left [m]";
}
std::string_view x_label(PositionView view) { return over_time(view) ? "true time [s]" : "x, forward [m]"; }

void draw_panel(drawing::Svg& svg, const drawing::PlotFrame& frame, const Selection& s, const drawing::Names& names,
                PositionView view, bool with_x, bool numbers) {
  frame.draw(svg, with_x ? x_label(view) : "", y_label(view));
  // In the plane, the data lie above the leaders; over time, above the thin lines.
  draw_instants(svg, frame, s, view, numbers);
  draw_data(svg, frame, s, names, view);
}

std::string scale_note(const Extents& e, const drawing::Area& area) {
  const double ratio = (area.width / e.x.size()) / (area.height / e.y.size());
  return std::abs(ratio - 1) < 0.02 ? "Both axes have the same scale." : "The axes have different scales.";
}

}  // namespace

std::string PositionPlots::over_time_svg() const {
  const Selection s = select();
  const std::string title = options_.title.empty() ? "Position over time" : options_.title;
  if (s.empty()) return drawing::empty_picture(title, "There are no positions in this window.");
  const std::span<const Selection> one(&s, 1);
  const std::vector<drawing::LegendEntry> legend = legend_of(one, names_);
  constexpr double kWidth = 1120, kHeight = 330;
  const double top = 36 + legend_height(legend, kWidth) + 8 + kStrip;
  drawing::Svg svg(kLeft + kWidth + 20, top + 2 * kHeight + 28 + 68, title);
  svg.text({kLeft + kWidth / 2, 22}, title, {.size = 14, .anchor = drawing::Anchor::kMiddle, .bold = true});
  draw_legend(svg, {kLeft, 36}, kWidth, legend);
  double y = top;
  for (const PositionView view : {PositionView::kXOverTime, PositionView::kYOverTime}) {
    const Extents e = extents_of(one, view);
    const bool last = view == PositionView::kYOverTime;
    draw_panel(svg, drawing::PlotFrame({kLeft, y, kWidth, kHeight}, e.x, e.y), s, names_, view, last, !last);
    y += kHeight + 28;
  }
  svg.text({kLeft, y - 28 + 60}, kCaption, {.size = 10, .fill = "#444444"});
  return svg.str();
}

std::string PositionPlots::plane_svg() const {
  const PositionPlots* const self = this;
  const std::vector<std::string> titles{""};
  return comparison_svg({&self, 1}, titles, PositionView::kPlane,
                        options_.title.empty() ? "Position in the plane" : options_.title);
}

std::string comparison_svg(std::span<const PositionPlots* const> plots, std::span<const std::string> titles,
                           PositionView view, std::string_view title) {
  TTF_CHECK(plots.size() == titles.size(), "{} panels and {} titles", plots.size(), titles.size());
  std::vector<Selection> selections;
  for (const PositionPlots* p : plots) selections.push_back(p->select());
  if (std::ranges::all_of(selections, [](const Selection& s) { return s.empty(); }))
    return drawing::empty_picture(title.empty() ? "Positions" : title, "There are no positions in this window.");
  Extents e = extents_of(selections, view);
  const double n = static_cast<double>(plots.size());
  const double width = plots.size() == 1 ? 1120 : std::max(460.0, 1320 / n - 40);
  double height = plots.size() == 1 ? 560 : 430;
  if (!over_time(view)) {
    // Both axes have the same scale if that leaves room for the narrower one.
    const double equal = width * e.y.size() / e.x.size();
    if (equal >= 0.3 * width && equal <= 1.3 * width) height = equal;
  }
  const double panel = width + kLeft + 10, total = panel * n;
  const std::vector<drawing::LegendEntry> legend = legend_of(selections, plots.front()->names());
  const bool headed = std::ranges::any_of(titles, [](const std::string& t) { return !t.empty(); });
  const double legend_top = title.empty() ? 10 : 36;
  const double top =
      legend_top + legend_height(legend, total - kLeft) + (headed ? 30 : 8) + (over_time(view) ? kStrip : 0);
  drawing::Svg svg(total + 16, top + height + 68, title.empty() ? "Comparison" : title);
  if (!title.empty())
    svg.text({kLeft + (total - kLeft) / 2, 22}, title, {.size = 14, .anchor = drawing::Anchor::kMiddle, .bold = true});
  draw_legend(svg, {kLeft, legend_top}, total - kLeft, legend);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const double left = kLeft + static_cast<double>(i) * panel;
    const drawing::Area area{left, top, width, height};
    if (!titles[i].empty())
      svg.text({left + width / 2, top - 8 - (over_time(view) ? kStrip : 0)}, titles[i],
               {.size = 12.5, .anchor = drawing::Anchor::kMiddle, .bold = true});
    draw_panel(svg, drawing::PlotFrame(area, e.x, e.y), selections[i], plots[i]->names(), view, true, true);
  }
  std::string caption(kCaption);
  if (!over_time(view)) caption += " " + scale_note(e, {0, 0, width, height});
  svg.text({kLeft, top + height + 60}, caption, {.size = 10, .fill = "#444444"});
  return svg.str();
}

}  // namespace ttf::report::plots
