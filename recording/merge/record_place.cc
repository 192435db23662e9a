#include "recording/merge/record_place.h"

#include <algorithm>
#include <array>
#include <limits>

#include "schedules/model/round.h"

namespace ttf::recording::merge {
namespace {

// Causes before effects.
constexpr std::array<log::RecordKind, log::kRecordKinds> kCausalOrder{
    log::RecordKind::kFault,          log::RecordKind::kPower,         log::RecordKind::kGuardian,
    log::RecordKind::kChannelFrame,   log::RecordKind::kSlotFrame,     log::RecordKind::kSymbol,
    log::RecordKind::kCanFrame,       log::RecordKind::kTimingProblem, log::RecordKind::kSlotProblem,
    log::RecordKind::kClockCorrected, log::RecordKind::kStateChange,   log::RecordKind::kListHop,
    log::RecordKind::kMeasured,       log::RecordKind::kFusionInput,   log::RecordKind::kObservation,
    log::RecordKind::kListFused,      log::RecordKind::kTrack,         log::RecordKind::kFusionStep,
    log::RecordKind::kReference,      log::RecordKind::kImage,         log::RecordKind::kFeature,
    log::RecordKind::kTruth,          log::RecordKind::kTaskRun,       log::RecordKind::kPrecision,
    log::RecordKind::kLateness,       log::RecordKind::kMedium};

constexpr std::array<std::uint8_t, log::kRecordKinds> ranks() {
  std::array<std::uint8_t, log::kRecordKinds> ranks{};
  for (auto& rank : ranks) rank = log::kRecordKinds;
  for (std::size_t i = 0; i < log::kRecordKinds; ++i)
    ranks[static_cast<std::size_t>(kCausalOrder[i]) - 1] = static_cast<std::uint8_t>(i);
  return ranks;
}
constexpr std::array<std::uint8_t, log::kRecordKinds> kRanks = ranks();
static_assert(std::find(kRanks.begin(), kRanks.end(), log::kRecordKinds) == kRanks.end(), "every kind has a rank");

// What a fault does is stamped by nodes, in whole microticks of theirs, and may seem to come before it by less than
// this.
constexpr std::int64_t kMicroticks_ns = schedules::model::kGranularity_ns;
constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();

constexpr std::uint8_t rank_of(log::RecordKind kind) { return kRanks[static_cast<std::size_t>(kind) - 1]; }

}  // namespace

void Placing::of_node(log::RecordKind kind, TrueTime at, NodeId node) {
  placed({at, rank_of(kind), true, index_of(node)});
}
void Placing::of_run(log::RecordKind kind, TrueTime at, std::uint64_t about) {
  placed({at, rank_of(kind), false, about});
}

void Placing::on(const records::Measured& r) { of_node(log::RecordKind::kMeasured, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::CanFrameSent& r) { of_node(log::RecordKind::kCanFrame, r.end.true_time, r.end.node); }
void Placing::on(const records::SlotFrameSent& r) {
  of_node(log::RecordKind::kSlotFrame, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::SlotProblem& r) {
  of_node(log::RecordKind::kSlotProblem, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::ListHop& r) { of_node(log::RecordKind::kListHop, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::TaskRun& r) { of_node(log::RecordKind::kTaskRun, r.start.true_time, r.start.node); }
void Placing::on(const records::ClockCorrected& r) {
  of_node(log::RecordKind::kClockCorrected, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::PrecisionSample& r) { of_run(log::RecordKind::kPrecision, r.at, 0); }
void Placing::on(const records::FusionInput& r) {
  of_node(log::RecordKind::kFusionInput, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::ListFused& r) { of_node(log::RecordKind::kListFused, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FusionStep& r) {
  of_node(log::RecordKind::kFusionStep, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::TrackState& r) { of_node(log::RecordKind::kTrack, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ObservationSeen& r) {
  of_node(log::RecordKind::kObservation, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::ImageWritten& r) { of_node(log::RecordKind::kImage, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FeatureUsed& r) { of_node(log::RecordKind::kFeature, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::ReferenceFix& r) {
  of_run(log::RecordKind::kReference, r.measured_true, index_of(r.object));
}
void Placing::on(const records::TruthState& r) { of_node(log::RecordKind::kTruth, r.at, r.node); }
void Placing::on(const records::StateChanged& r) {
  of_node(log::RecordKind::kStateChange, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::SymbolSent& r) { of_node(log::RecordKind::kSymbol, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::PowerChanged& r) { of_node(log::RecordKind::kPower, r.stamp.true_time, r.stamp.node); }
void Placing::on(const records::FaultActivity& r) {
  of_run(log::RecordKind::kFault, TrueTime{std::max(r.at.ns, kEarliest + kMicroticks_ns) - kMicroticks_ns},
         std::uint64_t{r.fault} << 8 | r.what);
}
void Placing::on(const records::GuardianIntervention& r) {
  of_run(log::RecordKind::kGuardian, r.at, std::uint64_t{r.channel} << 8 | index_of(r.branch));
}
void Placing::on(const records::ChannelFrame& r) {
  of_run(log::RecordKind::kChannelFrame, r.start, std::uint64_t{r.channel} << 8 | index_of(r.sender));
}
void Placing::on(const records::TimingProblem& r) {
  of_node(log::RecordKind::kTimingProblem, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::LatenessHistogram& r) {
  of_node(log::RecordKind::kLateness, r.stamp.true_time, r.stamp.node);
}
void Placing::on(const records::MediumCounts& r) { of_node(log::RecordKind::kMedium, r.stamp.true_time, r.stamp.node); }

}  // namespace ttf::recording::merge
