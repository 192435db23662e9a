#include "sim/faults/families.h"

#include "faults/believed_schedule.h"

namespace ttf::sim::faults {
namespace {

using K = ttf::faults::FaultKind;

struct FamilyRow {
  K kind{};
  std::unique_ptr<ActiveFault> (*make)(const FaultSetting&);
};
constexpr std::array<FamilyRow, ttf::faults::kFaultKinds> kFamilies{{
    {K::kCrash, make_crash},
    {K::kOmission, make_omission},
    {K::kBabblingIdiot, make_babbling_idiot},
    {K::kMasquerading, make_masquerading},
    {K::kSosTiming, make_sos_timing},
    {K::kSosValue, make_sos_value},
    {K::kBitFlipHeader, make_header_flips},
    {K::kBitFlipPayload, make_payload_flips},
    {K::kBitFlipTrailer, make_trailer_flips},
    {K::kChannelSwap, make_channel_swap},
    {K::kByzantineClock, make_byzantine_clock},
    {K::kDrift, make_drift},
    {K::kLoneColdstart, make_lone_coldstart},
    {K::kDuplicateColdstart, make_duplicate_coldstart},
    {K::kWrongSchedule, make_wrong_schedule},
    {K::kNoise, make_noise},
    {K::kTransient, make_transient},
    {K::kCanOmission, make_can_omission},
    {K::kCanCorruption, make_can_corruption},
    {K::kCanBabbling, make_can_babbling},
    {K::kCanBusOff, make_can_bus_off},
    {K::kCanStuckDominant, make_can_stuck_dominant},
    {K::kCanNoAcknowledgement, make_can_no_acknowledgement},
}};
static_assert(ttf::faults::is_one_row_a_kind(kFamilies), "a kind that does nothing, or rows in another order");

}  // namespace

std::unique_ptr<ActiveFault> make_active_fault(const FaultSetting& setting) {
  if (ttf::faults::changes_schedule(setting.fault)) return make_wrong_schedule(setting);
  return kFamilies[index_of(setting.fault.kind)].make(setting);
}

}  // namespace ttf::sim::faults
