// One time for the logs of several hosts.
//
// In virtual time there is one true time, the simulator's. In a run by the wall clock (manifest: `clock` = wall) a
// record's true time is what the clock of its process' host showed, since the instant that the run was to start at.
// Processes of one host share it; different hosts' clocks are apart, and run at different rates. What their nodes have
// in common is the global time, and how a host's clock relates to it is in its logs: every ClockCorrected has a stamp
// of both, once per node and double cycle. So a host's clock T is put on the common scale by
//
//   M(T) = piecewise linear through (true time, global time + C) of the stamps of one of its nodes, that with the
//          most of them; before the first and after the last at the rate of the host's own clock
//
// with one C for all: the first stamp of the reference keeps its time. The reference is the host of the lowest such
// node. Accurate to the cluster's precision and what a clock is corrected by in a double cycle.
//
// Nodes count rounds of 64 cycles each for itself, and anew when they restart: whole rounds are added so that the first
// stamp of a host is within half a round of its clock (so hosts' clocks must agree to that: 160 ms at a cycle of 5 ms),
// and every other one has come on as that clock has. What goes back, or stands still, is passed over.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::recording::merge {

class StoredLog;

struct SyncStamp {
  NodeId node{};
  TrueTime at{};
  GlobalTime global{};
};

class CommonTime {
 public:
  struct Point {
    TrueTime host, common;
  };
  CommonTime() = default;                                                         // what it is given
  explicit CommonTime(std::vector<Point> points) : points_(std::move(points)) {}  // both growing

  TrueTime operator()(TrueTime host) const;  // never decreasing
  bool changes_nothing() const { return points_.empty(); }

 private:
  std::vector<Point> points_;
};

// For each log. They change nothing in virtual time and where all are of one host, nor for a host without a
// synchronised node, which gets a warning.
std::vector<CommonTime> common_times(const std::vector<StoredLog>& logs, std::vector<std::string>& warnings);

// Passes every record on with its true times put on the common scale. Both must outlive the sink.
std::unique_ptr<records::Sink> on_common_time(const CommonTime& time, records::Sink& out);

}  // namespace ttf::recording::merge
