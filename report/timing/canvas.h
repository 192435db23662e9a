// The layout of a timing diagram while it is drawn: lanes from top to bottom, time from left to right.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/time.h"
#include "report/drawing/names.h"
#include "report/drawing/svg.h"
#include "report/timing/data.h"
#include "report/timing/lanes.h"
#include "report/timing/tags.h"
#include "report/timing/transfers.h"
#include "report/timing/ways.h"

namespace ttf::report::timing {

struct TimingCanvas {
  const drawing::Names& names;
  const TimingData& data;
  TrueTime from, to;
  TimingTags tags;
  drawing::Area plot;
  std::map<LaneKey, double> centres;
  drawing::Sheet sheet;

  static constexpr double kBox = 14, kText = 9.5;  // height of slots and tasks, size of their text

  double x(TrueTime t) const {
    return plot.x + static_cast<double>((t - from).ns) / static_cast<double>((to - from).ns) * plot.width;
  }
  double y(const LaneKey& lane) const { return centres.at(lane); }
  bool visible(TrueTime start, TrueTime end) const { return start < to && end >= from; }
  double inside(double px) const { return std::clamp(px, plot.x, plot.x + plot.width); }
  // Returns the hover text's times; empty in a page, whose script adds them.
  std::string times(TrueTime start, TrueTime end) const;
};

double lane_height(const Lane& lane);

// Draws the arrows of one measurement or one image.
void draw_way(drawing::Svg& svg, const TimingCanvas& canvas, const Way& way);
// Draws labels where space is free; called last.
void draw_labels(drawing::Svg& svg, const TimingCanvas& canvas, const std::vector<Transfer>& transfers);

}  // namespace ttf::report::timing
