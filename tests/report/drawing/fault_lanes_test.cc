#include "report/drawing/fault_lanes.h"

#include <gtest/gtest.h>

#include <vector>

namespace ttf::report::drawing {
namespace {

TEST(FaultLanes, AFaultHasALaneFromItsBeginToItsEnd) {
  const auto record = [](std::int64_t at, std::uint32_t fault, recording::records::FaultAct what) {
    return FaultEvent(recording::records::FaultActivity{{at}, fault, what, kNoNode, "noise", ""});
  };
  using namespace recording::records;
  const std::vector<FaultEvent> events = {record(10, 0, FaultAct::kBegins), record(20, 0, FaultAct::kEnds),
                                          record(10, 1, FaultAct::kBegins), record(60, 1, FaultAct::kEnds),
                                          record(30, 2, FaultAct::kBegins), record(90, 3, FaultAct::kBegins)};
  EXPECT_EQ(FaultLanes(events, {}, {40}, {80}).count(), 2u);
  EXPECT_EQ(FaultLanes(events, {}, {0}, {100}).count(), 4u);
  EXPECT_EQ(FaultLanes(events, {}, {0}, {10}).count(), 0u);
}

}  // namespace
}  // namespace ttf::report::drawing
