// Records to protobuf messages and back. Private to the module, as it includes generated code.
//
// An encoder reuses its messages. It sets every field and never calls Clear(), which would free nested
// messages. It uses no heap once the lists have had their largest size. A Decoder checks that every number fits
// its field's type and that lists have their lengths. On failure it returns false and calls no sink.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "recording/log/log.pb.h"
#include "recording/records/kinds.h"
#include "recording/records/records.h"

namespace ttf::recording::log {

// The message of each kind of record. A kind without one does not compile.
template <class Record> struct PayloadOf;
template <> struct PayloadOf<records::Measured> : std::type_identity<ttfusion::Measured> {};
template <> struct PayloadOf<records::CanFrameSent> : std::type_identity<ttfusion::CanFrame> {};
template <> struct PayloadOf<records::SlotFrameSent> : std::type_identity<ttfusion::SlotFrame> {};
template <> struct PayloadOf<records::SlotProblem> : std::type_identity<ttfusion::SlotProblem> {};
template <> struct PayloadOf<records::ListHop> : std::type_identity<ttfusion::ListHop> {};
template <> struct PayloadOf<records::TaskRun> : std::type_identity<ttfusion::TaskRun> {};
template <> struct PayloadOf<records::ClockCorrected> : std::type_identity<ttfusion::ClockCorrected> {};
template <> struct PayloadOf<records::PrecisionSample> : std::type_identity<ttfusion::Precision> {};
template <> struct PayloadOf<records::FusionInput> : std::type_identity<ttfusion::FusionInput> {};
template <> struct PayloadOf<records::ListFused> : std::type_identity<ttfusion::ListFused> {};
template <> struct PayloadOf<records::FusionStep> : std::type_identity<ttfusion::FusionStep> {};
template <> struct PayloadOf<records::TrackState> : std::type_identity<ttfusion::Track> {};
template <> struct PayloadOf<records::ObservationSeen> : std::type_identity<ttfusion::Observation> {};
template <> struct PayloadOf<records::ImageWritten> : std::type_identity<ttfusion::Image> {};
template <> struct PayloadOf<records::FeatureUsed> : std::type_identity<ttfusion::Feature> {};
template <> struct PayloadOf<records::ReferenceFix> : std::type_identity<ttfusion::Reference> {};
template <> struct PayloadOf<records::TruthState> : std::type_identity<ttfusion::Truth> {};
template <> struct PayloadOf<records::EgoTruth> : std::type_identity<ttfusion::Ego> {};
template <> struct PayloadOf<records::Warning> : std::type_identity<ttfusion::Warning> {};
template <> struct PayloadOf<records::CommandIssued> : std::type_identity<ttfusion::Command> {};
template <> struct PayloadOf<records::CommandTaken> : std::type_identity<ttfusion::Actuator> {};
template <> struct PayloadOf<records::DetectionMade> : std::type_identity<ttfusion::Detection> {};
template <> struct PayloadOf<records::SequencePlanned> : std::type_identity<ttfusion::Sequence> {};
template <> struct PayloadOf<records::PlanMade> : std::type_identity<ttfusion::Plan> {};
template <> struct PayloadOf<records::StateChanged> : std::type_identity<ttfusion::StateChange> {};
template <> struct PayloadOf<records::SymbolSent> : std::type_identity<ttfusion::Symbol> {};
template <> struct PayloadOf<records::PowerChanged> : std::type_identity<ttfusion::Power> {};
template <> struct PayloadOf<records::FaultActivity> : std::type_identity<ttfusion::Fault> {};
template <> struct PayloadOf<records::GuardianIntervention> : std::type_identity<ttfusion::Guardian> {};
template <> struct PayloadOf<records::ChannelFrame> : std::type_identity<ttfusion::ChannelFrame> {};
template <> struct PayloadOf<records::TimingProblem> : std::type_identity<ttfusion::TimingProblem> {};
template <> struct PayloadOf<records::LatenessHistogram> : std::type_identity<ttfusion::Lateness> {};
template <> struct PayloadOf<records::MediumCounts> : std::type_identity<ttfusion::Medium> {};
template <> struct PayloadOf<records::CanErrorFrame> : std::type_identity<ttfusion::CanError> {};
template <> struct PayloadOf<records::CanStateChanged> : std::type_identity<ttfusion::CanState> {};
template <> struct PayloadOf<records::OdometryTaken> : std::type_identity<ttfusion::Odometry> {};
template <class Record> using Payload = typename PayloadOf<Record>::type;

// One message per kind, for reuse.
class Payloads {
 public:
  template <class Record> Payload<Record>& of() { return std::get<Payload<Record>>(all_); }
  // Null if the number is no kind.
  google::protobuf::Message* of(records::RecordKind kind) {
    google::protobuf::Message* payload = nullptr;
    records::for_kind(kind, [&]<class Record>() { payload = &of<Record>(); });
    return payload;
  }

 private:
  template <std::size_t... i>
  static std::tuple<Payload<records::RecordAt<i + 1>>...> each_of(std::index_sequence<i...>);  // only its type counts
  decltype(each_of(std::make_index_sequence<records::kKindCount>{})) all_;
};

// The two stamps that MCAP keeps per message, before negative values are clamped to 0.
struct LogTimes {
  std::int64_t log = 0;
  std::int64_t publish = 0;
};

struct Encoded {
  records::RecordKind kind{};
  const google::protobuf::Message& payload;
  LogTimes times;
};
// Fills the payload of every record that it receives, and hands it to `out`.
std::unique_ptr<records::Sink> encoder(Payloads& payloads, std::function<void(const Encoded&)> out);

class Decoder {
 public:
  // Parses one payload and hands the record to `sink`.
  bool decode(records::RecordKind kind, std::string_view bytes, records::Sink& sink);

  // Storage for a record's lists during the call of the sink.
  struct Lists {
    std::vector<ObjectId> truth_ids;
    std::vector<records::ImageObject> image_objects;
    std::vector<MeasurementId> newest;
    std::vector<records::FeatureObject> feature_objects;
    std::vector<std::uint64_t> counts;
  };

 private:
  Payloads payloads_;
  Lists lists_;
};

}  // namespace ttf::recording::log
