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
#include "report/timing/lanes.h"
#include "report/timing/tags.h"

namespace ttf::report::timing {

class ProblemMarks {
 public:
  // Those in the window.
  ProblemMarks(const TimingData& data, const drawing::Names& names, const std::vector<Lane>& lanes, TrueTime from,
               TrueTime to);

  void draw(drawing::Svg& svg,
            const std::function<drawing::Point(const ttf::report::timing::LaneKey&, ttf::TrueTime)>& place,
            const TimingTags& tags) const;
  void add_to(std::vector<drawing::LegendEntry>& legend) const;

 private:
  struct Mark {
    LaneKey lane;
    TrueTime at;
    std::string words;
  };
  std::vector<Mark> marks_;
};

}  // namespace ttf::report::timing
