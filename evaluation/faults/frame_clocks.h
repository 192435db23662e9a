// How far the clocks of nodes are apart, told from the frames they send: each begins when its sender's own clock says
// so.
//
//   cycle    |  2k                    |  2k+1                  |
//   node n   ----T(2k)--------------------T(2k+1)-----------E-->   true time
//
// Within a double cycle a clock runs at one rate, and its offset is corrected at the end. So its rate is known from the
// first frame the node sends in either cycle, and with it E: the true time at which its clock shows the end of the
// double cycle, the correction of its offset left out. The clocks are apart by the difference of their E, which is the
// largest of the double cycle but for what they come together in it. Exact to the nanoseconds that records are rounded
// to.
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

  // A frame of a node whose clock counts, in the order of time. The largest distance to any other such clock in the
  // same double cycle, where this frame makes it known.
  std::optional<Duration> sent(const recording::records::SlotFrameSent& frame);
  // The node's clock counts no more, until it sends again.
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
    std::optional<TrueTime> end;  // of the newest double cycle that is known
  };
  Duration cycle_;
  std::vector<Clock> clocks_;  // by NodeId
};

}  // namespace ttf::evaluation::faults
