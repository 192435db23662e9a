// A panel of a position plot: one object in one view.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "report/drawing/axes.h"
#include "report/plots/position_plot.h"

namespace ttf::report::plots {

inline constexpr double kStrip = 20;  // the row of numbered instants above a panel over time

inline bool over_time(PositionView view) { return view != PositionView::kPlane; }

struct Extents {
  drawing::Extent x, y;
};
// Returns the extents with a margin around the data.
Extents padded(Extents e, PositionView view);

drawing::Point coordinates(const PositionPlots::Sample& s, PositionView view);
std::string_view x_label(PositionView view);
std::string_view y_label(PositionView view);

// Returns the extents of all samples, with that margin; `every_sample(one, visit)` visits those of one.
template <class One, class Every>
Extents extents_of(std::span<const One> all, PositionView view, const Every& every_sample) {
  Extents e;
  for (const One& one : all)
    every_sample(one, [&](const PositionPlots::Sample& sample) {
      const drawing::Point p = coordinates(sample, view);
      e.x.add(p.x);
      e.y.add(p.y);
    });
  return padded(e, view);
}
Extents extents_of(std::span<const PositionPlots::Selection> selections, PositionView view);

std::vector<drawing::LegendEntry> legend_of(std::span<const PositionPlots::Selection> selections,
                                            const drawing::Names& names);

// `with_x`: with the numbers and the label of the x axis. `numbers`: with those of fusion instants.
void draw_panel(drawing::Svg& svg, const drawing::PlotFrame& frame, const PositionPlots::Selection& s,
                const drawing::Names& names, PositionView view, bool with_x, bool numbers, const drawing::Sheet& sheet);

}  // namespace ttf::report::plots
