// The lanes of a timing diagram.
#pragma once

#include <string>
#include <vector>

#include "report/drawing/names.h"
#include "report/timing/data.h"
#include "report/timing/ways.h"

namespace ttf::report::timing {

struct Lane {
  LaneKey key;
  std::string label;
  int section = 0;  // 0 sensors, 1 up to the gateway, 2 FlexRay, 3 fusion, 4 features
};
// Returns the lanes from top to bottom; section 1 in the order in which measurements pass.
std::vector<Lane> lanes_of(const TimingData& data, const drawing::Names& names, const Ways& ways);

}  // namespace ttf::report::timing
