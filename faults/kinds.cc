#include "faults/kinds.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::faults {
namespace {

using K = FaultKind;
using P = FaultParameter;
using D = NodeDemand;

constexpr std::array<FaultKindRow, kFaultKinds> kKindRows{{
    {K::kCrash, "crash", {P::kWindow}},
    {K::kOmission, "omission", {P::kDirection, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kBabblingIdiot, "babbling_idiot", {P::kSignal, P::kLength, P::kBursts, P::kChannels, P::kWindow}},
    {K::kMasquerading, "masquerading", {P::kMasquerade, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kSosTiming, "sos_timing", {P::kShift, P::kReceivers, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kSosValue, "sos_value", {P::kReceivers, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kBitFlipHeader, "bit_flip_header", {P::kHeaderBits, P::kReceivers, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kBitFlipPayload, "bit_flip_payload", {P::kPayloadBits, P::kReceivers, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kBitFlipTrailer, "bit_flip_trailer", {P::kTrailerBits, P::kReceivers, P::kOccasions, P::kChannels, P::kWindow}},
    {K::kChannelSwap, "channel_swap", {P::kOccasions, P::kWindow}, Failing::kNode, NodeDemand::kBothChannels},
    {K::kByzantineClock, "byzantine_clock", {P::kLie, P::kWindow}},
    {K::kDrift, "drift", {P::kDrift, P::kFrom}},
    {K::kLoneColdstart, "lone_coldstart", {P::kOthers, P::kWindow}, Failing::kOthers, NodeDemand::kColdstart},
    {K::kDuplicateColdstart,
     "duplicate_coldstart",
     {P::kDuplicate, P::kBursts, P::kChannels, P::kWindow},
     Failing::kNode,
     NodeDemand::kColdstart},
    {K::kWrongSchedule, "wrong_schedule", {P::kWrongSchedule}},
    {K::kNoise, "noise", {P::kLength, P::kBursts, P::kChannels, P::kWindow}, Failing::kMedium},
    {K::kTransient, "transient", {P::kChannels, P::kPassing}, Failing::kMedium},
    {K::kCanOmission, "can_omission", {P::kCan, P::kDirection, P::kOccasions, P::kWindow}, Failing::kNode, D::kOnCan},
    {K::kCanCorruption,
     "can_corruption",
     {P::kCan, P::kCanBit, P::kReceivers, P::kOccasions, P::kWindow},
     Failing::kNode,
     D::kOnCan},
    {K::kCanBabbling, "can_babbling", {P::kCan, P::kIdentifier, P::kBursts, P::kWindow}, Failing::kNode, D::kOnCan},
    {K::kCanBusOff, "can_bus_off", {P::kCan, P::kWindow}, Failing::kNode, D::kOnCan},
    {K::kCanStuckDominant, "can_stuck_dominant", {P::kCan, P::kWindow}, Failing::kNode, D::kOnCan},
    {K::kCanNoAcknowledgement, "can_no_acknowledgement", {P::kCan, P::kWindow}, Failing::kNode, D::kOnCan},
}};
static_assert(is_one_row_a_kind(kKindRows), "a kind without a row, or rows in another order");

}  // namespace

const FaultKindRow& row_of(FaultKind kind) {
  TTF_CHECK(index_of(kind) < kKindRows.size(), "fault kind {}", index_of(kind));
  return kKindRows[index_of(kind)];
}

bool takes(FaultKind kind, FaultParameter parameter) {
  const auto& all = row_of(kind).parameters;
  return std::find(all.begin(), all.end(), parameter) != all.end();
}

}  // namespace ttf::faults
