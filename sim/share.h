// What one process of several writes down, where each simulates one node and all of them the media: of what belongs to
// no executive - signals' ways on the channels, guardians' interventions, faults - each process hears everything. It
// keeps what is of its own node, and one of them, that of the first node, what is of none; together they keep each once.
#pragma once

#include "core/ids.h"
#include "recording/records/records.h"

namespace ttf::sim {

class Share final : public records::Sink {
 public:
  Share(NodeId self, records::Sink& out) : self_(self), out_(out) {}

  void on(const records::Measured& record) override { out_.on(record); }
  void on(const records::CanFrameSent& record) override { out_.on(record); }
  void on(const records::SlotFrameSent& record) override { out_.on(record); }
  void on(const records::SlotProblem& record) override { out_.on(record); }
  void on(const records::ListHop& record) override { out_.on(record); }
  void on(const records::TaskRun& record) override { out_.on(record); }
  void on(const records::ClockCorrected& record) override { out_.on(record); }
  void on(const records::PrecisionSample& record) override { out_.on(record); }
  void on(const records::FusionInput& record) override { out_.on(record); }
  void on(const records::ListFused& record) override { out_.on(record); }
  void on(const records::FusionStep& record) override { out_.on(record); }
  void on(const records::TrackState& record) override { out_.on(record); }
  void on(const records::ObservationSeen& record) override { out_.on(record); }
  void on(const records::ImageWritten& record) override { out_.on(record); }
  void on(const records::FeatureUsed& record) override { out_.on(record); }
  void on(const records::ReferenceFix& record) override { out_.on(record); }
  void on(const records::TruthState& record) override { out_.on(record); }
  void on(const records::StateChanged& record) override { out_.on(record); }
  void on(const records::SymbolSent& record) override { out_.on(record); }
  void on(const records::PowerChanged& record) override { out_.on(record); }
  void on(const records::FaultActivity& record) override { if (is_mine(record.node)) out_.on(record); }
  void on(const records::GuardianIntervention& record) override { if (is_mine(record.branch)) out_.on(record); }
  void on(const records::ChannelFrame& record) override { if (is_mine(record.sender)) out_.on(record); }

 private:
  bool is_mine(NodeId node) const { return node == self_ || (node == kNoNode && self_ == NodeId{}); }

  NodeId self_;
  records::Sink& out_;
};

}  // namespace ttf::sim
