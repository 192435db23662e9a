// A panel of several objects in one view. Up to PositionPlots::Crowd::kMostTrails objects have a trail each, in a colour of
// their own: the truth is wide and pale, the track thin. A circle with the object's number is at their end, and the number is
// left out where it would cover another. More objects are drawn as a density: a cell's shade counts the tracks' positions in it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/plots/position_panel.h"

namespace ttf::report::plots {

Extents extents_of(std::span<const PositionPlots::Crowd> crowds, PositionView view);
std::vector<drawing::LegendEntry> legend_of(std::span<const PositionPlots::Crowd> crowds);
// Returns a sentence for the caption.
std::string words_of(std::span<const PositionPlots::Crowd> crowds);
// Returns the colour of the i-th object; colours repeat after kMostTrails.
std::string object_colour(std::size_t i);

void draw_panel(drawing::Svg& svg, const drawing::PlotFrame& frame, const PositionPlots::Crowd& crowd,
                PositionView view, bool with_x, const drawing::Sheet& sheet);

}  // namespace ttf::report::plots
