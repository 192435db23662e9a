// What a timing diagram shows of what was not in its time, in runs in real time: a mark where it was noticed, on the
// channel where it is about a slot, else in the first lane of the node's tasks. Where there is no such lane there is no
// mark.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/timing/data.h"
#include "report/timing/tags.h"
#include "report/timing/ways.h"

namespace ttf::report {

class ProblemMarks {
 public:
  // Those in the window.
  ProblemMarks(const TimingData& data, const Names& names, const std::vector<Lane>& lanes, TrueTime from, TrueTime to);

  void draw(Svg& svg, const std::function<Point(const LaneKey&, TrueTime)>& place, const TimingTags& tags) const;
  void add_to(std::vector<LegendEntry>& legend) const;

 private:
  struct Mark {
    LaneKey lane;
    TrueTime at;
    std::string words;
  };
  std::vector<Mark> marks_;
};

}  // namespace ttf::report
