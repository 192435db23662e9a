// How well the clocks of a cluster agreed in a run by the wall clock, from what each node's log says of its own.
//
// Every ClockCorrected has the node's global time and the host's clock (the stamp's true time) of one instant, once per
// double cycle. Between two of them
//
//   global - host, at t = o1 + (o2 - o1) (t - t1) / (t2 - t1),     o = global - host at t1 and t2
//
// and how far apart a set of nodes is at t is the largest of these less the smallest, whole rounds of the cycle counter
// left out: nodes count these each for itself. Asked at every stamp of every node; there nodes are near stamps of their
// own, so that what a correction does in between matters little. Only nodes of one host share its clock: those of
// different hosts are not compared. A node that leaves out two stamps has no global time between its last and its next.
#pragma once

#include <deque>
#include <map>
#include <string>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"

namespace ttf::evaluation::lateness {

class AchievedPrecision {
 public:
  // `cycle`: nominal length of the communication cycle; 0, or longer than any can be: nothing is compared.
  explicit AchievedPrecision(Duration cycle);

  // Of one host's nodes, in the order of its clock.
  void add(const recording::records::Stamp& stamp);
  // At the end, once: the differences at all instants at which two nodes or more had a global time.
  recording::records::BinnedDurations finish();

 private:
  struct Offset {
    TrueTime at{};
    std::int64_t ns = 0;  // global less true time
  };
  std::int64_t within_round(std::int64_t ns) const;
  void compare(TrueTime at);

  std::int64_t round_ns_ = 0;
  Duration longest_gap_{};
  std::map<NodeId, std::deque<Offset>> offsets_;  // of each: what is needed still
  std::deque<TrueTime> instants_;                 // to be compared, when all have said what they showed then
  recording::records::BinnedDurations apart_;
};

}  // namespace ttf::evaluation::lateness
