// Puts the logs of several machines on one time scale.
//
// In virtual time there is one true time, the simulator's. In a drive by the wall clock (manifest: `clock` =
// wall) a record's true time is that of the machine's clock since the start of the drive. Processes of one
// machine share it; different machines' clocks differ, and run at different rates. Their nodes share the global
// time. A machine's logs relate its clock to the global time: every ClockCorrected has a stamp of both, once
// per node and double cycle. The common time of a machine's clock T is
//
//   M(T) = piecewise linear through (true time, global time + C) of the stamps of one of its nodes, the one with
//          the most stamps; before the first and after the last at the rate of the machine's own clock
//
// with one C for all: the first stamp of the reference keeps its time. The reference is the machine of the
// lowest such node. The error is bounded by the cluster's precision plus a clock's correction in a double
// cycle.
//
// Each node counts rounds of cycles for itself, and anew after a restart. Whole rounds are added so that a
// machine's first stamp is within half a round of its clock, and every other stamp advances as that clock does.
// Machines' clocks must therefore agree to half a round: 160 ms at 64 cycles of 5 ms. A stamp that goes back or
// stands still is ignored.
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
  CommonTime() = default;                                                         // leaves times as they are
  explicit CommonTime(std::vector<Point> points) : points_(std::move(points)) {}  // both coordinates increase

  TrueTime operator()(TrueTime host) const;  // never decreasing
  bool changes_nothing() const { return points_.empty(); }

 private:
  std::vector<Point> points_;
};

// Returns the scale of each log. It changes no time in virtual time, if all logs are of one machine, or for a
// machine without a synchronised node; the last adds a warning.
std::vector<CommonTime> common_times(const std::vector<StoredLog>& logs, std::vector<std::string>& warnings);

// Passes every record on with its true times put on the common scale. Both arguments must outlive the sink.
std::unique_ptr<records::Sink> on_common_time(const CommonTime& time, records::Sink& out);

}  // namespace ttf::recording::merge
