// Many objects in one view: a cell's shade counts the positions of tracks in it. Another colour shows cells with a true
// object that has no track.
#pragma once

#include <vector>

#include "report/drawing/axes.h"
#include "report/plots/position_panel.h"

namespace ttf::report::plots {

inline constexpr double kGap_s = 0.5;  // a line or a shade ends where samples are further apart

std::vector<drawing::LegendEntry> density_legend();

// Over time, a position counts until the next image, and a true object until its next sample.
void draw_density(drawing::Svg& svg, const drawing::PlotFrame& frame, const PositionPlots::Crowd& crowd,
                  PositionView view);

}  // namespace ttf::report::plots
