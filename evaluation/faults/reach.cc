#include "evaluation/faults/reach.h"

#include <algorithm>
#include <array>

#include "bus/wire/flexray_frame.h"

namespace ttf::evaluation::faults {
namespace {

using K = ttf::faults::FaultKind;

struct ReachRow {
  K kind{};
  bool supply = false, reception = false, channel = false, clocks = false;
};
constexpr std::array<ReachRow, ttf::faults::kFaultKinds> kReaches{{
    {.kind = K::kCrash, .supply = true, .reception = true},
    {.kind = K::kOmission, .reception = true},  // not if it acts on sending only
    {.kind = K::kBabblingIdiot, .channel = true},
    {.kind = K::kMasquerading, .channel = true},
    {.kind = K::kSosTiming, .channel = true, .clocks = true},
    {.kind = K::kSosValue},
    {.kind = K::kBitFlipHeader},
    {.kind = K::kBitFlipPayload},
    {.kind = K::kBitFlipTrailer},
    {.kind = K::kChannelSwap, .channel = true},
    {.kind = K::kByzantineClock, .clocks = true},
    {.kind = K::kDrift, .reception = true, .clocks = true},
    {.kind = K::kLoneColdstart, .supply = true, .reception = true},
    {.kind = K::kDuplicateColdstart, .reception = true, .channel = true, .clocks = true},
    {.kind = K::kWrongSchedule, .reception = true, .channel = true, .clocks = true},
    {.kind = K::kNoise, .channel = true},
    {.kind = K::kTransient, .channel = true, .clocks = true},  // acts on sync frames, too
    {.kind = K::kCanOmission},                                 // this and the others of a CAN: nothing on FlexRay
    {.kind = K::kCanCorruption},
    {.kind = K::kCanBabbling},
    {.kind = K::kCanBusOff},
    {.kind = K::kCanStuckDominant},
    {.kind = K::kCanNoAcknowledgement},
}};
static_assert(ttf::faults::is_one_row_a_kind(kReaches), "a kind without a reach, or rows in another order");

}  // namespace

std::vector<bool> named_by(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster) {
  std::vector<bool> named(cluster.nodes.size(), false);
  if (fault.node != kNoNode) named[index_of(fault.node)] = true;
  if (ttf::faults::row_of(fault.kind).failing != ttf::faults::Failing::kOthers) return named;
  for (std::size_t n = 0; n < named.size(); ++n) {
    const auto& p = cluster.nodes[n].flexray;
    if (p && (fault.all_others || p->pKeySlotUsedForStartup)) named[n] = true;
  }
  return named;
}

bool takes_supply(const ttf::faults::Fault& fault, NodeId node) {
  const bool spares_node =
      ttf::faults::row_of(fault.kind).failing == ttf::faults::Failing::kOthers && fault.node == node;
  return kReaches[index_of(fault.kind)].supply && !spares_node;
}

FaultReach reach_of(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster) {
  const ReachRow& row = kReaches[index_of(fault.kind)];
  const Duration frame = bus::wire::frame_duration(cluster.flexray, static_cast<int>(bus::wire::kMaxPayloadBytes / 2));
  const bool of_sending_only = ttf::faults::takes(fault.kind, ttf::faults::FaultParameter::kDirection) &&
                               fault.direction == ttf::faults::FaultDirection::kSend;
  // A kind without a length or shift of its own has 0 there, so it lasts as long as a frame.
  return {row.reception && !of_sending_only, row.channel, row.clocks,
          std::max(frame, fault.length) + std::max(fault.shift, Duration{})};
}

}  // namespace ttf::evaluation::faults
