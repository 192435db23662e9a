#include "recording/merge/record_place.h"

#include <algorithm>
#include <array>
#include <limits>

#include "schedules/model/round.h"

namespace ttf::recording {
namespace {

// Causes before effects.
constexpr std::array<RecordKind, kRecordKinds> kCausalOrder{
    RecordKind::kFault,       RecordKind::kPower,          RecordKind::kGuardian,    RecordKind::kChannelFrame,
    RecordKind::kSlotFrame,   RecordKind::kSymbol,         RecordKind::kCanFrame,    RecordKind::kTimingProblem,
    RecordKind::kSlotProblem, RecordKind::kClockCorrected, RecordKind::kStateChange, RecordKind::kListHop,
    RecordKind::kMeasured,    RecordKind::kFusionInput,    RecordKind::kObservation, RecordKind::kListFused,
    RecordKind::kTrack,       RecordKind::kFusionStep,     RecordKind::kReference,   RecordKind::kImage,
    RecordKind::kFeature,     RecordKind::kTruth,          RecordKind::kTaskRun,     RecordKind::kPrecision,
    RecordKind::kLateness,    RecordKind::kMedium};

constexpr std::array<std::uint8_t, kRecordKinds> ranks() {
  std::array<std::uint8_t, kRecordKinds> ranks{};
  for (auto& rank : ranks) rank = kRecordKinds;
  for (std::size_t i = 0; i < kRecordKinds; ++i)
    ranks[static_cast<std::size_t>(kCausalOrder[i]) - 1] = static_cast<std::uint8_t>(i);
  return ranks;
}
constexpr std::array<std::uint8_t, kRecordKinds> kRanks = ranks();
static_assert(std::find(kRanks.begin(), kRanks.end(), kRecordKinds) == kRanks.end(), "every kind has a rank");

// What a fault does is stamped by nodes, in whole microticks of theirs, and may seem to come before it by less than
// this.
constexpr std::int64_t kMicroticks_ns = schedules::kGranularity_ns;
constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();

constexpr std::uint8_t rank_of(RecordKind kind) { return kRanks[static_cast<std::size_t>(kind) - 1]; }

}  // namespace

void Placing::of_node(RecordKind kind, TrueTime at, NodeId node) { placed({at, rank_of(kind), true, index_of(node)}); }
void Placing::of_run(RecordKind kind, TrueTime at, std::uint64_t about) { placed({at, rank_of(kind), false, about}); }

void Placing::on(const records::Measured& r) { of_node(RecordKind::kMeasured, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::CanFrameSent& r) { of_node(RecordKind::kCanFrame, r.end.true_time, r.end.node); }
void Placing::on(const records::SlotFrameSent& r) { of_node(RecordKind::kSlotFrame, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::SlotProblem& r) { of_node(RecordKind::kSlotProblem, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ListHop& r) { of_node(RecordKind::kListHop, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::TaskRun& r) { of_node(RecordKind::kTaskRun, r.start.true_time, r.start.node); }
void Placing::on(const records::ClockCorrected& r) {
  of_node(RecordKind::kClockCorrected, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::PrecisionSample& r) { of_run(RecordKind::kPrecision, r.at, 0); }
void Placing::on(const records::FusionInput& r) { of_node(RecordKind::kFusionInput, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ListFused& r) { of_node(RecordKind::kListFused, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FusionStep& r) { of_node(RecordKind::kFusionStep, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::TrackState& r) { of_node(RecordKind::kTrack, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ObservationSeen& r) {
  of_node(RecordKind::kObservation, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::ImageWritten& r) { of_node(RecordKind::kImage, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FeatureUsed& r) { of_node(RecordKind::kFeature, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ReferenceFix& r) {
  of_run(RecordKind::kReference, r.measured_true, index_of(r.object));
}
void Placing::on(const records::TruthState& r) { of_node(RecordKind::kTruth, r.at, r.node); }
void Placing::on(const records::StateChanged& r) { of_node(RecordKind::kStateChange, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::SymbolSent& r) { of_node(RecordKind::kSymbol, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::PowerChanged& r) { of_node(RecordKind::kPower, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FaultActivity& r) {
  of_run(RecordKind::kFault, TrueTime{std::max(r.at.ns, kEarliest + kMicroticks_ns) - kMicroticks_ns},
         std::uint64_t{r.fault} << 8 | r.what);
}
void Placing::on(const records::GuardianIntervention& r) {
  of_run(RecordKind::kGuardian, r.at, std::uint64_t{r.channel} << 8 | index_of(r.branch));
}
void Placing::on(const records::ChannelFrame& r) {
  of_run(RecordKind::kChannelFrame, r.start, std::uint64_t{r.channel} << 8 | index_of(r.sender));
}
void Placing::on(const records::TimingProblem& r) {
  of_node(RecordKind::kTimingProblem, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::LatenessHistogram& r) {
  of_node(RecordKind::kLateness, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::MediumCounts& r) { of_node(RecordKind::kMedium, r.stamp.true_time, r.stamp.node); }

}  // namespace ttf::recording
