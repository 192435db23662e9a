#include "experiments/campaign/flexray/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "experiments/campaign/drawing.h"
#include "faults/believed_schedule.h"
#include "schedules/model/limits.h"

namespace ttf::experiments::campaign::flexray {
namespace {

using faults::Fault;
using faults::FaultKind;
using faults::FaultParameter;
using schedules::model::Channels;

constexpr int kMostPayloadWords = schedules::model::kMostFragmentBytes / 2;  // cPayloadLengthMax

bool others_fail(FaultKind kind) { return faults::row_of(kind).failing == faults::Failing::kOthers; }

class FlexRayDrawing final : public Drawing {
 public:
  FlexRayDrawing(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::uint32_t index)
      : Drawing(campaign, index), cluster_(cluster), g_(cluster.flexray), cycle_(cluster.cycle()) {}

  DrawnFault fault() {
    Fault fault;
    fault.kind = kind();
    const bool starts_up = uniform() < campaign().startup_share || others_fail(fault.kind);
    const bool coldstart = faults::row_of(fault.kind).demand == faults::NodeDemand::kColdstart;
    if (faults::has_node(fault.kind)) fault.node = node(coldstart);
    when(fault, starts_up);
    for (const FaultParameter parameter : faults::row_of(fault.kind).parameters)
      if (faults::applies(parameter, fault)) draw(parameter, fault);
    if (faults::changes_schedule(fault)) always(fault);
    return {fault, starts_up};
  }

 private:
  NodeId node(bool coldstart) {
    std::vector<NodeId> candidates;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      if (!coldstart || cluster_.nodes[n].flexray->pKeySlotUsedForStartup) candidates.push_back(static_cast<NodeId>(n));
    TTF_CHECK(!candidates.empty(), "no coldstart node in {}", cluster_.name);
    return one_of(candidates);
  }
  // A running cluster has had cycles without a fault, a start-up has not. One fault in three lasts to the end.
  void when(Fault& fault, bool starts_up) {
    fault.from = starts_up ? between(Duration{}, cycle_ * 12) : between(cycle_ * 4, cycle_ * 8);
    if (others_fail(fault.kind)) fault.from = Duration{};
    if (uniform() < 2.0 / 3.0) fault.duration = between(Duration{cycle_.ns / 5}, cycle_ * 10);
    if (faults::takes(fault.kind, FaultParameter::kFrom)) fault.duration = Fault::kToTheEnd;
    if (faults::takes(fault.kind, FaultParameter::kPassing) && fault.duration == Fault::kToTheEnd)
      fault.duration = between(Duration::microseconds(1), cycle_);
  }

  void draw(FaultParameter parameter, Fault& fault) {
    struct Row {
      FaultParameter parameter{};
      void (FlexRayDrawing::*draw)(Fault&) = nullptr;
    };
    using P = FaultParameter;
    static constexpr std::array<Row, faults::kFaultParameters> kRows{{
        {P::kNone, &FlexRayDrawing::nothing},
        {P::kDirection, &FlexRayDrawing::direction},
        {P::kSignal, &FlexRayDrawing::signal},
        {P::kLength, &FlexRayDrawing::noise_length},
        {P::kBursts, &FlexRayDrawing::bursts},
        {P::kMasquerade, &FlexRayDrawing::masquerade},
        {P::kShift, &FlexRayDrawing::shift},
        {P::kLie, &FlexRayDrawing::lie},
        {P::kHeaderBits, &FlexRayDrawing::flips},
        {P::kPayloadBits, &FlexRayDrawing::flips},
        {P::kTrailerBits, &FlexRayDrawing::flips},
        {P::kDrift, &FlexRayDrawing::drift},
        {P::kOthers, &FlexRayDrawing::others},
        {P::kDuplicate, &FlexRayDrawing::duplicate},
        {P::kWrongSchedule, &FlexRayDrawing::wrong_schedule},
        {P::kReceivers, &FlexRayDrawing::receivers},
        {P::kOccasions, &FlexRayDrawing::occasions},
        {P::kChannels, &FlexRayDrawing::fault_channels},
        {P::kWindow, &FlexRayDrawing::nothing},  // this and the next two: drawn before, by when()
        {P::kFrom, &FlexRayDrawing::nothing},
        {P::kPassing, &FlexRayDrawing::nothing},
        {P::kCan, &FlexRayDrawing::nothing},  // this and the next two: for campaigns on a CAN
        {P::kCanBit, &FlexRayDrawing::nothing},
        {P::kIdentifier, &FlexRayDrawing::nothing},
    }};
    static_assert(faults::is_one_row_a_parameter(kRows), "a parameter without a row, or rows in another order");
    const std::size_t row = faults::index_of(parameter);
    TTF_CHECK(row < kRows.size(), "parameter {}", row);
    (this->*kRows[row].draw)(fault);
  }

  void nothing(Fault&) {}
  void direction(Fault& fault) { fault.direction = Drawing::direction(); }
  void signal(Fault& fault) {
    fault.signal = one_of(std::vector{faults::FaultSignal::kNoise, faults::FaultSignal::kFrame});
    if (fault.signal == faults::FaultSignal::kFrame) length();  // unused there, but part of campaigns' streams
  }
  void noise_length(Fault& fault) { fault.length = length(); }
  void masquerade(Fault& fault) {
    fault.masquerade = one_of(std::vector{faults::MasqueradeMode::kInSlot, faults::MasqueradeMode::kOwnSlot});
    fault.slot = one_of(slots_of_others(fault.node, false));
  }
  // Up to twice the room before the action point: some frames leave the slot, others just do not.
  void shift(Fault& fault) {
    fault.shift = signed_up_to(Duration{2 * g_.gdActionPointOffset * g_.gdMacrotick_ps / 1000});
  }
  void lie(Fault& fault) {
    fault.shift = between(Duration{100}, Duration{g_.gdActionPointOffset * g_.gdMacrotick_ps / 1000});
    fault.pattern = one_of(std::vector{faults::ByzantinePattern::kRandom, faults::ByzantinePattern::kPullApart,
                                       faults::ByzantinePattern::kPullRates});
  }
  // The frame CRC finds up to five flips in any frame; it misses more of them once in 2^24.
  void flips(Fault& fault) { fault.flips = uniform() < 0.75 ? number(1, 5) : number(6, 24); }
  // From unnoticeable to untrackable: 10 ppm to 50000 ppm, evenly in the logarithm.
  void drift(Fault& fault) {
    const double ppb = 1e4 * std::pow(5'000.0, uniform());
    fault.drift_ppb = static_cast<std::int64_t>(ppb) * (uniform() < 0.5 ? -1 : 1);
  }
  void others(Fault& fault) { fault.all_others = uniform() < 0.5; }
  void fault_channels(Fault& fault) { fault.channels = channels(); }

  // A wrong belief holds from the beginning to the end.
  static void always(Fault& fault) {
    fault.from = Duration{};
    fault.duration = Fault::kToTheEnd;
  }
  // Returns by how many macroticks at most every static slot may be longer in the same cycle.
  int room_in_slots() const {
    return std::min(g_.gdNIT - 2, g_.gOffsetCorrectionStart - (g_.gMacroPerCycle - g_.gdNIT)) / g_.gNumberOfStaticSlots;
  }
  // Returns the wrong schedules with room in the cluster; a wrong length of the cycle is always possible.
  std::vector<faults::WrongSchedule> wrong_schedules(NodeId node) const {
    std::vector<faults::WrongSchedule> possible;
    if (g_.gNumberOfStaticSlots > 1) possible.push_back(faults::WrongSchedule::kShiftedSlots);
    possible.push_back(faults::WrongSchedule::kCycleLength);
    if (room_in_slots() > 0) possible.push_back(faults::WrongSchedule::kStaticSlot);
    if (g_.gPayloadLengthStatic < kMostPayloadWords) possible.push_back(faults::WrongSchedule::kPayloadLength);
    if (!slots_of_others(node, false).empty()) possible.push_back(faults::WrongSchedule::kKeySlot);
    return possible;
  }
  void duplicate(Fault& fault) {
    std::vector possible{faults::DuplicateMode::kCas, faults::DuplicateMode::kStartupFrames};
    if (!slots_of_others(fault.node, true).empty()) possible.push_back(faults::DuplicateMode::kSameKeySlot);
    fault.duplicate = one_of(possible);
    switch (fault.duplicate) {
      case faults::DuplicateMode::kCas:
        channels();  // unused, as its length is, but part of campaigns' streams
        length();
        return;
      case faults::DuplicateMode::kStartupFrames: return;
      case faults::DuplicateMode::kSameKeySlot: fault.slot = one_of(slots_of_others(fault.node, true)); return;
    }
  }
  void wrong_schedule(Fault& fault) {
    fault.wrong = one_of(wrong_schedules(fault.node));
    switch (fault.wrong) {
      case faults::WrongSchedule::kShiftedSlots: fault.by = number(1, g_.gNumberOfStaticSlots - 1); return;
      case faults::WrongSchedule::kCycleLength: fault.by = number(1, 100); return;
      case faults::WrongSchedule::kStaticSlot: fault.by = number(1, room_in_slots()); return;
      case faults::WrongSchedule::kPayloadLength:
        fault.by = number(1, kMostPayloadWords - g_.gPayloadLengthStatic);
        return;
      case faults::WrongSchedule::kKeySlot: fault.slot = one_of(slots_of_others(fault.node, false)); return;
    }
  }
  void occasions(Fault& fault) { Drawing::occasions(fault); }
  // From back to back to once in some cycles.
  void bursts(Fault& fault) { Drawing::bursts(fault, static_cast<double>(cycle_.ns) * 3e-4); }
  void receivers(Fault& fault) {
    std::vector<NodeId> all;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) all.push_back(static_cast<NodeId>(n));
    Drawing::receivers(fault, all);
  }
  std::vector<int> slots_of_others(NodeId node, bool coldstart) const {
    std::vector<int> slots;
    for (const schedules::model::FrameSlot& frame : cluster_.frames) {
      const schedules::model::NodeParameters& p = *cluster_.node(frame.sender).flexray;
      if (frame.sender == node || frame.slot > g_.gNumberOfStaticSlots) continue;
      if (!coldstart || (p.pKeySlotUsedForStartup && p.pKeySlotId == frame.slot)) slots.push_back(frame.slot);
    }
    return slots;
  }
  Duration length() { return between(Duration::microseconds(1), Duration::microseconds(300)); }
  Channels channels() { return one_of(std::vector{Channels::kAB, Channels::kAB, Channels::kA, Channels::kB}); }

  Duration signed_up_to(Duration most) { return uniform() < 0.5 ? between({100}, most) : -between({100}, most); }

  const schedules::model::Cluster& cluster_;
  const schedules::model::GlobalParameters& g_;
  Duration cycle_;
};

}  // namespace

bool in_hypothesis(const Fault& fault) {
  if (others_fail(fault.kind)) return false;
  return faults::has_node(fault.kind) || fault.channels != Channels::kAB;
}

DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::uint32_t index) {
  return FlexRayDrawing(campaign, cluster, index).fault();
}

}  // namespace ttf::experiments::campaign::flexray
