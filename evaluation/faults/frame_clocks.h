// Finds the differences of nodes' clocks from their frames: each frame begins when its sender's own clock says
// so.
//
//   cycle    |  2k                    |  2k+1                  |
//   node n   ----T(2k)--------------------T(2k+1)-----------E-->   true time
//
// Within a double cycle a clock runs at one rate, and its offset is corrected at the end. The first frames that
// the node sends in both cycles give its rate. The rate gives E, the true time at which the clock shows the end
// of the double cycle, without the offset correction. Two clocks differ by the difference of their E. This is
// their largest difference in the double cycle, unless they approach each other in it. It is exact to the
// nanoseconds to which records are rounded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

class FrameClocks {
 public:
  explicit FrameClocks(const schedules::model::Cluster& cluster);

  // Takes a frame of a node whose clock counts, in the order of time. If the frame gives its sender's E,
  // returns the largest difference to any other such clock in the same double cycle.
  std::optional<Duration> sent(const recording::records::SlotFrameSent& frame);
  // Ignores the node's clock until it sends again.
  void forget(NodeId node);

 private:
  struct Reading {
    bool known = false;
    std::int64_t cycle = 0;
    TrueTime at{};
    GlobalTime shown{};
  };
  struct Clock {
    Reading first;                // the first frame of the newest even cycle
    std::optional<TrueTime> end;  // the newest known double cycle's
  };
  Duration cycle_;
  std::vector<Clock> clocks_;  // by NodeId
};

}  // namespace ttf::evaluation::faults
