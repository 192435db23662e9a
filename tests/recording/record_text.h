// A sink that turns every record into one line of text, exact to the last bit of every number, so that what
// was written and what was read can be compared. And records to write: drawn at random, with extreme values
// among them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/records/records.h"

namespace ttf::recording {

class TextSink final : public records::Sink {
 public:
  std::vector<std::string> lines;

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
};

// What the drawn fields look like. kSmallest and kLargest: every field at that end of its type, lists empty
// and long; kDrawn: anything, with times near `at`.
enum class Values { kSmallest, kLargest, kZero, kDrawn };

// One record of `kind` (1..25), a pure function of the arguments, to `sink`.
void emit(records::Sink& sink, int kind, Values values, std::uint32_t index, std::int64_t at_ns);

}  // namespace ttf::recording
