#include "recording/merge/record_place.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "recording/records/every.h"
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
template <class Record> RecordPlace of_node(const Record& record, const records::Stamp& stamp) {
  return of_node(record, stamp.true_time, stamp.node);
}
template <class Record> RecordPlace of_drive(const Record& record, TrueTime at, std::uint64_t about) {
  return {at, rank_of(record), false, about};
}

RecordPlace place_of(const records::Measured& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::CanFrameSent& r) { return of_node(r, r.end); }
RecordPlace place_of(const records::CanErrorFrame& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::CanStateChanged& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::SlotFrameSent& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::SlotProblem& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::ListHop& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::TaskRun& r) { return of_node(r, r.start); }
RecordPlace place_of(const records::ClockCorrected& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::PrecisionSample& r) { return of_drive(r, r.at, 0); }
RecordPlace place_of(const records::FusionInput& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::OdometryTaken& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::ListFused& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::FusionStep& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::TrackState& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::ObservationSeen& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::ImageWritten& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::FeatureUsed& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::ReferenceFix& r) { return of_drive(r, r.measured_true, index_of(r.object)); }
RecordPlace place_of(const records::TruthState& r) { return of_node(r, r.at, r.node); }
RecordPlace place_of(const records::EgoTruth& r) { return of_node(r, r.at, r.node); }
RecordPlace place_of(const records::Warning& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::CommandIssued& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::CommandTaken& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::DetectionMade& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::SequencePlanned& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::PlanMade& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::StateChanged& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::SymbolSent& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::PowerChanged& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::FaultActivity& r) {
  return of_drive(r, TrueTime{std::max(r.at.ns, kEarliest + kMicroticks_ns) - kMicroticks_ns},
                  std::uint64_t{r.fault} << 8 | r.what);
}
RecordPlace place_of(const records::GuardianIntervention& r) {
  return of_drive(r, r.at, std::uint64_t{r.channel} << 8 | index_of(r.branch));
}
RecordPlace place_of(const records::ChannelFrame& r) {
  return of_drive(r, r.start, std::uint64_t{r.channel} << 8 | index_of(r.sender));
}
RecordPlace place_of(const records::TimingProblem& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::LatenessHistogram& r) { return of_node(r, r.stamp); }
RecordPlace place_of(const records::MediumCounts& r) { return of_node(r, r.stamp); }

class Placing final : public records::Every<Placing> {
 public:
  explicit Placing(std::function<void(const RecordPlace&)> placed) : placed_(std::move(placed)) {}

  template <class Record> void each(const Record& record) {
    static_assert(
        requires { place_of(record); }, "a kind of record that has no place among the others");
    placed_(place_of(record));
  }

 private:
  std::function<void(const RecordPlace&)> placed_;
};

}  // namespace

std::unique_ptr<records::Sink> placing(std::function<void(const RecordPlace&)> placed) {
  return std::make_unique<Placing>(std::move(placed));
}

}  // namespace ttf::recording::merge
