// Passes every record on to several sinks, in their order.
#pragma once

#include <utility>
#include <vector>

#include "recording/records/records.h"

namespace ttf::records {

class Tee final : public Sink {
 public:
  explicit Tee(std::vector<Sink*> sinks) : sinks_(std::move(sinks)) {}
  void on(const Measured& record) override { pass(record); }
  void on(const CanFrameSent& record) override { pass(record); }
  void on(const SlotFrameSent& record) override { pass(record); }
  void on(const SlotProblem& record) override { pass(record); }
  void on(const ListHop& record) override { pass(record); }
  void on(const TaskRun& record) override { pass(record); }
  void on(const ClockCorrected& record) override { pass(record); }
  void on(const PrecisionSample& record) override { pass(record); }
  void on(const FusionInput& record) override { pass(record); }
  void on(const ListFused& record) override { pass(record); }
  void on(const FusionStep& record) override { pass(record); }
  void on(const TrackState& record) override { pass(record); }
  void on(const ObservationSeen& record) override { pass(record); }
  void on(const ImageWritten& record) override { pass(record); }
  void on(const FeatureUsed& record) override { pass(record); }
  void on(const ReferenceFix& record) override { pass(record); }
  void on(const TruthState& record) override { pass(record); }
  void on(const StateChanged& record) override { pass(record); }
  void on(const SymbolSent& record) override { pass(record); }
  void on(const PowerChanged& record) override { pass(record); }
  void on(const FaultActivity& record) override { pass(record); }
  void on(const GuardianIntervention& record) override { pass(record); }
  void on(const ChannelFrame& record) override { pass(record); }

 private:
  template <class Record>
  void pass(const Record& record) {
    for (Sink* sink : sinks_) sink->on(record);
  }
  std::vector<Sink*> sinks_;
};

}  // namespace ttf::records
