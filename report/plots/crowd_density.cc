#include "report/plots/crowd_density.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace ttf::report::plots {
namespace {

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

// Counts in cells: positions of tracks, and whether a true object has none.
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

}  // namespace

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

}  // namespace ttf::report::plots
