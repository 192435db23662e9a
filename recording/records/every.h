// A sink that does the same with every kind of record: whoever derives from it says once, in each(), what that is.
// The list of kinds stands here and in Sink alone, so that a new kind reaches them all.
//
//   class Counter final : public Every<Counter> {
//    public:
//     template <class Record> void each(const Record&) { ++records_; }
//   ...
#pragma once

#include "recording/records/records.h"

namespace ttf::recording::records {

template <class Derived> class Every : public Sink {
 public:
  void on(const Measured& record) final { pass(record); }
  void on(const CanFrameSent& record) final { pass(record); }
  void on(const SlotFrameSent& record) final { pass(record); }
  void on(const SlotProblem& record) final { pass(record); }
  void on(const ListHop& record) final { pass(record); }
  void on(const TaskRun& record) final { pass(record); }
  void on(const ClockCorrected& record) final { pass(record); }
  void on(const PrecisionSample& record) final { pass(record); }
  void on(const FusionInput& record) final { pass(record); }
  void on(const ListFused& record) final { pass(record); }
  void on(const FusionStep& record) final { pass(record); }
  void on(const TrackState& record) final { pass(record); }
  void on(const ObservationSeen& record) final { pass(record); }
  void on(const ImageWritten& record) final { pass(record); }
  void on(const FeatureUsed& record) final { pass(record); }
  void on(const ReferenceFix& record) final { pass(record); }
  void on(const TruthState& record) final { pass(record); }
  void on(const StateChanged& record) final { pass(record); }
  void on(const SymbolSent& record) final { pass(record); }
  void on(const PowerChanged& record) final { pass(record); }
  void on(const FaultActivity& record) final { pass(record); }
  void on(const GuardianIntervention& record) final { pass(record); }
  void on(const ChannelFrame& record) final { pass(record); }
  void on(const TimingProblem& record) final { pass(record); }
  void on(const LatenessHistogram& record) final { pass(record); }
  void on(const MediumCounts& record) final { pass(record); }

 private:
  template <class Record> void pass(const Record& record) { static_cast<Derived&>(*this).each(record); }
};

}  // namespace ttf::recording::records
