// The timing problems in a timing diagram of a drive in real time: one mark where each was noticed. A problem of a slot
// is marked on its channel, any other in the first lane of the node's tasks. Without such a lane there is no mark.
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
  // Takes the problems in the window.
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
