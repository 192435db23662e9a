// Measures the agreement of a cluster's clocks in a drive by the wall clock, from each node's log of its own
// clock.
//
// Every ClockCorrected has the node's global time and the machine's clock (the stamp's true time) at one
// instant, once per double cycle. Between two of them
//
//   global - machine, at t = o1 + (o2 - o1) (t - t1) / (t2 - t1),     o = global - machine at t1 and t2
//
// The difference of a set of nodes at t is the largest of these minus the smallest. Whole rounds of the cycle
// counter are left out, since each node counts these for itself. The difference is taken at every stamp of
// every node. There the other nodes are near stamps of their own, so a correction in between matters little.
// Only nodes of one machine are compared, since they share its clock. A node that lacks two stamps has no
// global time from its last to its next.
#pragma once

#include <deque>
#include <map>
#include <string>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "schedules/model/round.h"

namespace ttf::evaluation::lateness {

class AchievedPrecision {
 public:
  // `cycle`: nominal length of the communication cycle. At 0, or if longer than possible, nothing is compared. `cycles`: values
  // of the cycle counter.
  explicit AchievedPrecision(Duration cycle, int cycles = schedules::model::kMostCycles);

  // Takes stamps of one machine's nodes, in the order of its clock.
  void add(const recording::records::Stamp& stamp);
  // Returns the differences at all instants at which two nodes or more had a global time. Call it once, at the
  // end.
  recording::records::BinnedDurations finish();

 private:
  struct Offset {
    TrueTime at{};
    std::int64_t ns = 0;  // global minus true time
  };
  std::int64_t within_round(std::int64_t ns) const;
  void compare(TrueTime at);

  std::int64_t round_ns_ = 0;
  Duration longest_gap_{};
  std::map<NodeId, std::deque<Offset>> offsets_;  // by node: those still needed
  std::deque<TrueTime> instants_;                 // to be compared once all nodes have stamped around them
  recording::records::BinnedDurations apart_;
};

}  // namespace ttf::evaluation::lateness
