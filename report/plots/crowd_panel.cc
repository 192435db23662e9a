#include "report/plots/crowd_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/plots/position_panel.h"

namespace ttf::report::plots {
namespace {

constexpr double kGap_s = 0.5;  // a line or a shade ends where samples are further apart

using Sample = PositionPlots::Sample;
using Crowd = PositionPlots::Crowd;

constexpr double kCell = 6;  // units
std::string untracked_colour() { return drawing::tint(drawing::kOrange, 0.45); }

// A cell's shade by its number of positions: each from this number on.
constexpr std::array<std::uint32_t, 5> kShades{1, 3, 10, 30, 100};
std::string shade(std::size_t i) { return drawing::tint(drawing::kBlue, 0.8 - 0.2 * static_cast<double>(i)); }
std::size_t shade_of(std::uint32_t count) {
  return static_cast<std::size_t>(std::ranges::upper_bound(kShades, count) - kShades.begin()) - 1;
}

// Counts in cells: positions of tracks, and whether a true object has none. A cell's shade counts the positions of tracks
// in it. Another colour shows cells with a true object that has no track.
class Density {
 public:
  Density(const drawing::Area& area, const drawing::PlotFrame& frame, PositionView view)
      : area_(area), frame_(frame), view_(view), columns_(cells_in(area.width)), rows_(cells_in(area.height)),
        tracks_(columns_ * rows_), missed_(columns_ * rows_) {}

  // Over time, a position counts in all cells until the instant `next`.
  void add(const Sample& s, double next, bool track) {
    const drawing::Point p = coordinates(s, view_), at = frame_.at(p.x, p.y);
    if (!(at.y >= area_.y && at.y <= area_.y + area_.height)) return;
    const std::size_t row = place(at.y - area_.y, rows_), first = place(at.x - area_.x, columns_);
    const std::size_t end = over_time(view_) ? place(frame_.at(next, p.y).x - area_.x, columns_) : first;
    for (std::size_t column = first; column < std::max(end, first + 1); ++column) {
      if (track)
        ++tracks_[row * columns_ + column];
      else
        missed_[row * columns_ + column] = true;
    }
  }

  void draw(drawing::Svg& svg) const {
    svg.open_group("density", area_);
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t first = 0, behind = 0; first < columns_; first = behind) {
        // Neighbours of one look are one rectangle.
        const std::size_t shown = look(row * columns_ + first);
        for (behind = first; behind < columns_ && look(row * columns_ + behind) == shown;) ++behind;
        if (shown == kEmpty) continue;
        const auto along = [](std::size_t cells) { return kCell * static_cast<double>(cells); };
        svg.rect({area_.x + along(first), area_.y + along(row), along(behind - first), kCell},
                 {.fill = shown == kUntracked ? untracked_colour() : shade(shown)}, {},
                 shown == kUntracked ? "untracked" : "cell");
      }
    svg.close_group();
  }

 private:
  static constexpr std::size_t kUntracked = kShades.size(), kEmpty = kUntracked + 1;

  static std::size_t cells_in(double length) { return static_cast<std::size_t>(std::ceil(length / kCell)); }
  static std::size_t place(double units, std::size_t cells) {
    // A damaged log may have any values.
    if (!(units > 0)) return 0;
    return static_cast<std::size_t>(std::min(units / kCell, static_cast<double>(cells - 1)));
  }
  std::size_t look(std::size_t cell) const {
    return missed_[cell] ? kUntracked : tracks_[cell] > 0 ? shade_of(tracks_[cell]) : kEmpty;
  }

  const drawing::Area& area_;
  const drawing::PlotFrame& frame_;
  PositionView view_;
  std::size_t columns_, rows_;
  std::vector<std::uint32_t> tracks_;
  std::vector<bool> missed_;
};

std::vector<drawing::LegendEntry> density_legend() {
  using K = drawing::LegendEntry::Kind;
  std::vector<drawing::LegendEntry> legend;
  for (std::size_t i = 0; i < kShades.size(); ++i)
    legend.push_back({K::kBox,
                      i + 1 < kShades.size() ? fmt::format("{} to {} positions", kShades[i], kShades[i + 1] - 1)
                                             : fmt::format("{} positions and more", kShades[i]),
                      shade(i),
                      {},
                      true});
  legend.push_back({K::kBox, "a true object without a track", untracked_colour(), {}, true});
  return legend;
}

// Over time, a position counts until the next image, and a true object until its next sample.
void draw_density(drawing::Svg& svg, const drawing::PlotFrame& frame, const Crowd& crowd, PositionView view) {
  Density density(frame.area(), frame, view);
  const auto until = [](double t, double next) { return std::min(next, t + kGap_s); };
  for (const Crowd::Trail& trail : crowd.trails)
    for (std::size_t i = 0; i < trail.truth.size(); ++i)
      if (trail.missed[i])
        density.add(trail.truth[i], until(trail.truth[i].t, trail.truth[std::min(i + 1, trail.truth.size() - 1)].t),
                    false);
  std::vector<double> images;  // their instants
  for (const Sample& s : crowd.tracks) images.push_back(s.t);
  std::ranges::sort(images);
  images.erase(std::unique(images.begin(), images.end()), images.end());
  // The last image lasts as long as the one before it.
  if (images.size() > 1) images.push_back(2 * images.back() - images[images.size() - 2]);
  for (const Sample& s : crowd.tracks) {
    const auto next = std::ranges::upper_bound(images, s.t);
    density.add(s, until(s.t, next == images.end() ? s.t : *next), true);
  }
  density.draw(svg);
}

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
