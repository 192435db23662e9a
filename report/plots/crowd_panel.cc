#include "report/plots/crowd_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "report/plots/crowd_density.h"

namespace ttf::report::plots {
namespace {

using Sample = PositionPlots::Sample;
using Crowd = PositionPlots::Crowd;

constexpr double kNear = 1.0;   // units: a line leaves out points that are nearer than this
constexpr double kBeside = 20;  // units right of a panel that numbers may use
constexpr double kTruthWidth = 3.2, kTrackWidth = 1.2;
constexpr std::string_view kLost = drawing::kGrey;
template <class Visit> void every_sample(const Crowd& crowd, const Visit& visit) {
  for (const Crowd::Trail& trail : crowd.trails)
    for (const auto* list : {&trail.truth, &trail.track})
      for (const Sample& sample : *list) visit(sample);
  for (const Sample& sample : crowd.tracks) visit(sample);
}

void draw_line(drawing::Svg& svg, const drawing::PlotFrame& frame, const std::vector<Sample>& samples,
               PositionView view, const drawing::Paint& paint, const std::string& hover, std::string_view css_class) {
  std::vector<drawing::Point> line;
  const auto finish = [&] {
    if (line.size() > 1) svg.polyline(line, paint, false, hover, css_class);
    line.clear();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool breaks = i > 0 && samples[i].t - samples[i - 1].t > kGap_s;
    const bool last = i + 1 == samples.size() || samples[i + 1].t - samples[i].t > kGap_s;
    if (breaks) finish();
    const drawing::Point p = coordinates(samples[i], view), at = frame.at(p.x, p.y);
    if (last || line.empty() || std::hypot(at.x - line.back().x, at.y - line.back().y) >= kNear) line.push_back(at);
  }
  finish();
}

void draw_trails(drawing::Svg& svg, const drawing::PlotFrame& frame, const Crowd& crowd, PositionView view,
                 const drawing::Sheet& sheet) {
  const auto at = [&](const Sample& s) {
    const drawing::Point p = coordinates(s, view);
    return frame.at(p.x, p.y);
  };
  svg.open_group("data", frame.area());
  for (std::size_t i = 0; i < crowd.trails.size(); ++i)
    draw_line(svg, frame, crowd.trails[i].truth, view,
              {.stroke = drawing::tint(object_colour(i), 0.55), .width = kTruthWidth},
              fmt::format("object {}", index_of(crowd.trails[i].object)), "truth");
  for (const Sample& s : crowd.tracks)
    svg.marker(drawing::Marker::kCross, at(s), 5, {.stroke = kLost, .width = 0.9},
               fmt::format("a track without an object: t {:.4f} s, x {:.2f} m, y {:.2f} m", s.t, s.x, s.y), "lost");
  for (std::size_t i = 0; i < crowd.trails.size(); ++i)
    draw_line(svg, frame, crowd.trails[i].track, view, {.stroke = object_colour(i), .width = kTrackWidth},
              fmt::format("track of object {}", index_of(crowd.trails[i].object)), "track");
  drawing::LabelSpace space;
  for (std::size_t i = 0; i < crowd.trails.size(); ++i) {
    const drawing::Point end = at(crowd.trails[i].truth.back());
    svg.marker(drawing::Marker::kCircle, end, 6.5, {.fill = object_colour(i), .stroke = "#ffffff", .width = 0.8},
               fmt::format("object {} at its end", index_of(crowd.trails[i].object)), "end");
    space.take({end.x - 4, end.y - 4, 8, 8});
    drawing::Point last = end;
    for (const Sample& s : crowd.trails[i].truth)
      if (const drawing::Point p = at(s); std::hypot(p.x - last.x, p.y - last.y) > 4) {
        space.take({p.x - 2, p.y - 2, 4, 4});
        last = p;
      }
  }
  svg.close_group();
  const drawing::Area& area = frame.area();
  const double right = area.x + area.width;
  drawing::Area bounds = area;
  if (over_time(view)) bounds.width += kBeside;
  const drawing::TextStyle style{.size = sheet.text(10), .halo = true};
  svg.open_group("numbers");
  for (const Crowd::Trail& trail : crowd.trails) {
    const std::string text = fmt::format("{}", index_of(trail.object));
    const drawing::Point end = at(trail.truth.back());
    const double half = drawing::text_width(text, style.size) / 2;
    // Over time, objects that are there at the end have their numbers beside the panel.
    const bool beside = over_time(view) && end.x > right - kBeside;
    const std::array<drawing::Point, 3> candidates{drawing::Point{beside ? right + 4 : end.x + 6, end.y + 4},
                                                   drawing::Point{end.x - half, end.y - 6},
                                                   drawing::Point{end.x - half, end.y + 5 + style.size}};
    const std::span<const drawing::Point> tried(candidates.data(), beside ? 1 : candidates.size());
    if (const auto place = space.place(text, style, tried, bounds)) svg.text(*place, text, style);
  }
  svg.close_group();
}

}  // namespace

std::string object_colour(std::size_t i) {
  constexpr std::array<std::string_view, 6> kColours{drawing::kBlue,   drawing::kVermilion, drawing::kGreen,
                                                     drawing::kPurple, drawing::kOrange,    drawing::kSkyBlue};
  constexpr std::array<double, 6> kDark{0, 0.45, 0, 0.65, 0.25, 0.6}, kLight{0, 0, 0.4, 0, 0.2, 0.35};
  const std::size_t turn = i / kColours.size() % kDark.size();
  return drawing::tint(drawing::darker(kColours[i % kColours.size()], kDark[turn]), kLight[turn]);
}

Extents extents_of(std::span<const Crowd> crowds, PositionView view) {
  return extents_of(crowds, view, [](const Crowd& crowd, const auto& visit) { every_sample(crowd, visit); });
}

std::vector<drawing::LegendEntry> legend_of(std::span<const Crowd> crowds) {
  using K = drawing::LegendEntry::Kind;
  std::vector<drawing::LegendEntry> legend;
  if (std::ranges::any_of(crowds, [](const Crowd& c) { return c.dense(); })) return density_legend();
  legend.push_back({K::kLine,
                    "wide: truth, a colour for each object",
                    drawing::tint(object_colour(0), 0.55),
                    {},
                    false,
                    {},
                    kTruthWidth});
  legend.push_back({K::kLine, "thin: track, as in the images", object_colour(0), {}, false, {}, kTrackWidth});
  legend.push_back(
      {K::kMarker, "object at the end, with its number", object_colour(0), drawing::Marker::kCircle, true});
  if (std::ranges::any_of(crowds, [](const Crowd& c) { return !c.tracks.empty(); }))
    legend.push_back({K::kMarker, "track without a true object", std::string(kLost), drawing::Marker::kCross});
  return legend;
}

std::string words_of(std::span<const Crowd> crowds) {
  std::size_t most = 0;
  for (const Crowd& crowd : crowds) most = std::max(most, crowd.trails.size());
  return std::ranges::any_of(crowds, [](const Crowd& c) { return c.dense(); })
             ? fmt::format("{} objects: a cell's shade counts the positions of tracks in it.", most)
             : fmt::format("{} objects: `diagram --object N` shows one in detail.", most);
}

void draw_panel(drawing::Svg& svg, const drawing::PlotFrame& frame, const Crowd& crowd, PositionView view, bool with_x,
                const drawing::Sheet& sheet) {
  frame.draw(svg, with_x ? x_label(view) : "", y_label(view));
  if (crowd.dense())
    draw_density(svg, frame, crowd, view);
  else
    draw_trails(svg, frame, crowd, view, sheet);
}

}  // namespace ttf::report::plots
