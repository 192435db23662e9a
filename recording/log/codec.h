// Records to protobuf messages and back. Private to the room: it drags in generated code.
//
// encode() fills a message that is used again and again: it sets every field, so that the message need not be
// cleared, for Clear() frees the messages within. No heap use once the lists have had their largest size. A
// Decoder checks that every number fits its field's type and that lists have their lengths: it returns false,
// and calls nothing, where they do not.
#pragma once

#include <vector>

#include "recording/log/log.pb.h"
#include "recording/log/manifest.h"
#include "recording/records/records.h"

namespace ttf::recording::log {

// The two stamps MCAP keeps per message, before they are clamped to be non-negative.
struct LogTimes {
  std::int64_t log = 0;
  std::int64_t publish = 0;
};

// One of each payload, for reuse.
struct Payloads {
  ttfusion::Measured measured;
  ttfusion::CanFrame can_frame;
  ttfusion::SlotFrame slot_frame;
  ttfusion::SlotProblem slot_problem;
  ttfusion::ListHop list_hop;
  ttfusion::TaskRun task_run;
  ttfusion::ClockCorrected clock_corrected;
  ttfusion::Precision precision;
  ttfusion::FusionInput fusion_input;
  ttfusion::ListFused list_fused;
  ttfusion::FusionStep fusion_step;
  ttfusion::Track track;
  ttfusion::Observation observation;
  ttfusion::Image image;
  ttfusion::Feature feature;
  ttfusion::Reference reference;
  ttfusion::Truth truth;
  ttfusion::StateChange state_change;
  ttfusion::Symbol symbol;
  ttfusion::Power power;
  ttfusion::Fault fault;
  ttfusion::Guardian guardian;
  ttfusion::ChannelFrame channel_frame;
  ttfusion::TimingProblem timing_problem;
  ttfusion::Lateness lateness;
  ttfusion::Medium medium;

  // The payload of each kind; null for a value that is no kind.
  google::protobuf::Message* of(RecordKind kind);
};

// Fill the payload of the record's kind; returns it with its kind and times.
struct Encoded {
  RecordKind kind{};
  const google::protobuf::Message* payload = nullptr;
  LogTimes times;
};
Encoded encode(const records::Measured&, Payloads&);
Encoded encode(const records::CanFrameSent&, Payloads&);
Encoded encode(const records::SlotFrameSent&, Payloads&);
Encoded encode(const records::SlotProblem&, Payloads&);
Encoded encode(const records::ListHop&, Payloads&);
Encoded encode(const records::TaskRun&, Payloads&);
Encoded encode(const records::ClockCorrected&, Payloads&);
Encoded encode(const records::PrecisionSample&, Payloads&);
Encoded encode(const records::FusionInput&, Payloads&);
Encoded encode(const records::ListFused&, Payloads&);
Encoded encode(const records::FusionStep&, Payloads&);
Encoded encode(const records::TrackState&, Payloads&);
Encoded encode(const records::ObservationSeen&, Payloads&);
Encoded encode(const records::ImageWritten&, Payloads&);
Encoded encode(const records::FeatureUsed&, Payloads&);
Encoded encode(const records::ReferenceFix&, Payloads&);
Encoded encode(const records::TruthState&, Payloads&);
Encoded encode(const records::StateChanged&, Payloads&);
Encoded encode(const records::SymbolSent&, Payloads&);
Encoded encode(const records::PowerChanged&, Payloads&);
Encoded encode(const records::FaultActivity&, Payloads&);
Encoded encode(const records::GuardianIntervention&, Payloads&);
Encoded encode(const records::ChannelFrame&, Payloads&);
Encoded encode(const records::TimingProblem&, Payloads&);
Encoded encode(const records::LatenessHistogram&, Payloads&);
Encoded encode(const records::MediumCounts&, Payloads&);

class Decoder {
 public:
  // Parses one payload and hands the record to `sink`.
  bool decode(RecordKind kind, std::string_view bytes, records::Sink& sink);

 private:
  Payloads payloads_;
  std::vector<ObjectId> truth_ids_;
  std::vector<records::ImageObject> image_objects_;
  std::vector<MeasurementId> newest_;
  std::vector<records::FeatureObject> feature_objects_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace ttf::recording::log
