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

// Passes every record on with its true times put on the common scale.
class OnCommonTime final : public records::Sink {
 public:
  OnCommonTime(const CommonTime& time, records::Sink& out) : time_(time), out_(out) {}

  void on(const records::Measured&) override;
  void on(const records::CanFrameSent&) override;
  void on(const records::SlotFrameSent&) override;
  void on(const records::SlotProblem&) override;
  void on(const records::ListHop&) override;
  void on(const records::TaskRun&) override;
  void on(const records::ClockCorrected&) override;
  void on(const records::PrecisionSample&) override;
  void on(const records::FusionInput&) override;
  void on(const records::ListFused&) override;
  void on(const records::FusionStep&) override;
  void on(const records::TrackState&) override;
  void on(const records::ObservationSeen&) override;
  void on(const records::ImageWritten&) override;
  void on(const records::FeatureUsed&) override;
  void on(const records::ReferenceFix&) override;
  void on(const records::TruthState&) override;
  void on(const records::StateChanged&) override;
  void on(const records::SymbolSent&) override;
  void on(const records::PowerChanged&) override;
  void on(const records::FaultActivity&) override;
  void on(const records::GuardianIntervention&) override;
  void on(const records::ChannelFrame&) override;
  void on(const records::TimingProblem&) override;
  void on(const records::LatenessHistogram&) override;
  void on(const records::MediumCounts&) override;

 private:
  void put(TrueTime& at) const { at = time_(at); }
  void put(records::Stamp& stamp) const { stamp.true_time = time_(stamp.true_time); }
  template <class Record, class... Members>
  void pass(Record record, Members... times) const;  // members: stamps and instants

  const CommonTime& time_;
  records::Sink& out_;
};

}  // namespace ttf::recording::merge
