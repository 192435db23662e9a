#include "recording/merge/record_place.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "recording/records/every.h"
#include "recording/records/fields.h"
#include "schedules/model/round.h"

namespace ttf::recording::merge {
namespace {

template <class... Records> struct Order {
  static constexpr std::uint8_t kNone = sizeof...(Records);
  template <class Record> static constexpr std::uint8_t rank() {
    std::uint8_t rank = kNone, next = 0;
    ((rank = std::is_same_v<Record, Records> ? next : rank, ++next), ...);
    return rank;
  }
};

// Causes before effects.
using CausalOrder =
    Order<records::FaultActivity, records::PowerChanged, records::GuardianIntervention, records::ChannelFrame,
          records::SlotFrameSent, records::SymbolSent, records::CanErrorFrame, records::CanStateChanged,
          records::CanFrameSent, records::TimingProblem, records::SlotProblem, records::ClockCorrected,
          records::StateChanged, records::ListHop, records::Measured, records::OdometryTaken, records::FusionInput,
          records::ObservationSeen, records::ListFused, records::TrackState, records::FusionStep, records::ReferenceFix,
          records::ImageWritten, records::FeatureUsed, records::Warning, records::PlanMade, records::CommandIssued,
          records::CommandTaken, records::DetectionMade, records::SequencePlanned, records::EgoTruth,
          records::TruthState, records::TaskRun, records::PrecisionSample, records::LatenessHistogram,
          records::MediumCounts>;
static_assert(CausalOrder::kNone == records::kKindCount, "each kind of record has one rank");

// Nodes stamp a fault's effects in whole microticks of their own; these may seem to precede it by less than
// this.
constexpr std::int64_t kMicroticks_ns = schedules::model::kGranularity_ns;
constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();

template <class Record> constexpr std::uint8_t rank_of(const Record&) {
  constexpr std::uint8_t kRank = CausalOrder::rank<Record>();
  static_assert(kRank != CausalOrder::kNone, "a kind of record without a rank");
  return kRank;
}
template <class Record> RecordPlace of_node(const Record& record, TrueTime at, NodeId node) {
  return {at, rank_of(record), true, index_of(node)};
}
template <class Record> RecordPlace of_drive(const Record& record, TrueTime at, std::uint64_t about) {
  return {at, rank_of(record), false, about};
}

template <class Record> RecordPlace place_of(const Record& r) {
  constexpr auto instant = records::kDescription<Record>.instant;
  if constexpr (requires { r.*instant; }) {
    return of_node(r, (r.*instant).true_time, (r.*instant).node);
  } else {
    static_assert(instant.node != nullptr, "a kind of record that has no place among the others");
    return of_node(r, r.*instant.true_time, r.*instant.node);
  }
}
RecordPlace place_of(const records::PrecisionSample& r) { return of_drive(r, r.at, 0); }
RecordPlace place_of(const records::ReferenceFix& r) { return of_drive(r, r.measured_true, index_of(r.object)); }
RecordPlace place_of(const records::FaultActivity& r) {
  return of_drive(r, TrueTime{std::max(r.at.ns, kEarliest + kMicroticks_ns) - kMicroticks_ns},
                  std::uint64_t{r.fault} << 8 | index_of(r.what));
}
RecordPlace place_of(const records::GuardianIntervention& r) {
  return of_drive(r, r.at, std::uint64_t{r.channel} << 8 | index_of(r.branch));
}
RecordPlace place_of(const records::ChannelFrame& r) {
  return of_drive(r, r.start, std::uint64_t{r.channel} << 8 | index_of(r.sender));
}

class Placing final : public records::Every<Placing> {
 public:
  explicit Placing(std::function<void(const RecordPlace&)> placed) : placed_(std::move(placed)) {}

  template <class Record> void each(const Record& record) { placed_(place_of(record)); }

 private:
  std::function<void(const RecordPlace&)> placed_;
};

}  // namespace

std::unique_ptr<records::Sink> placing(std::function<void(const RecordPlace&)> placed) {
  return std::make_unique<Placing>(std::move(placed));
}

}  // namespace ttf::recording::merge
