// A drive as a Perfetto trace, for ui.perfetto.dev and its SQL: Perfetto's TrackEvent protobuf
// (recording/exports/perfetto.proto).
//
//   a group a node   a lane per task, and lanes for its sensor's measurements, slot problems, lost lists and
//                    controller states. Counters: clock corrections [microticks]; for the feature service the age
//                    of the newest measurement in the image when used [ms]; for the fusion node the confirmed tracks
//   FlexRay          a lane per channel: frames and symbols as sent, with a mark where a frame differed on the channel.
//                    Counter: the clocks' precision [us]
//   CAN              a lane per bus: frames, with marks of error frames and of controllers' new states
//   faults           a lane per fault of the fault plan
//   flows            a measurement's way from sensor to feature service (recording/exports/measurement_ways.h)
//
// Timestamps are true times, nanoseconds since the start of the drive; earlier events stand at the start. The
// same records in the same order give the same bytes. Memory holds only the last seconds of the drive.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "recording/exports/frames.h"
#include "recording/exports/measurement_ways.h"
#include "recording/exports/trace_timeline.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

// Takes records in the order of MergedLogs::read(). Bytes go to `write` as they come; call finish() at the end.
class PerfettoExport final : public records::Sink {
 public:
  PerfettoExport(LogNames names, TraceTimeline::Write write);

  TraceCounts finish();

  using records::Sink::on;
  void on(const records::Measured&) override;
  void on(const records::CanFrameSent&) override;
  void on(const records::SlotFrameSent&) override;
  void on(const records::SlotProblem&) override;
  void on(const records::ListHop&) override;
  void on(const records::TaskRun&) override;
  void on(const records::ClockCorrected&) override;
  void on(const records::PrecisionSample&) override;
  void on(const records::ListFused&) override;
  void on(const records::FusionStep&) override;
  void on(const records::ImageWritten&) override;
  void on(const records::FeatureUsed&) override;
  void on(const records::StateChanged&) override;
  void on(const records::SymbolSent&) override;
  void on(const records::PowerChanged&) override;
  void on(const records::FaultActivity&) override;
  void on(const records::GuardianIntervention&) override;
  void on(const records::ChannelFrame&) override;
  void on(const records::TimingProblem&) override;
  void on(const records::CanErrorFrame&) override;
  void on(const records::CanStateChanged&) override;

 private:
  struct Image {
    std::uint32_t sequence = 0;
    TrueTime newest{};  // instant of the newest measurement in it
  };
  TrueTime come_to(TrueTime at);
  void on_act(const MeasurementWays::Act& act, const WayMark& run);
  void join(const MeasurementWays::Way& way);
  std::vector<TraceFlow> flows_of(const TraceMark& mark);
  TraceMark node_instant(NodeId node, const char* lane, TrueTime at, std::string name, std::vector<TraceNote> notes);
  template <class Record> void can_instant(const Record& record, std::string name, TraceNote note);
  std::string measurement(const MeasurementId& id) const;

  LogNames names_;
  MeasurementWays ways_;
  std::map<std::uint64_t, std::vector<TraceFlow>> flows_;  // by mark, until the mark is written
  TraceTimeline timeline_;
  std::deque<Image> images_;  // the last few
};

}  // namespace ttf::recording::exports
