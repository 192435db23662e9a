#include "sim/faults/families.h"

#include "core/check.h"

namespace ttf::sim::faults {

using ttf::faults::FaultKind;

std::unique_ptr<ActiveFault> make_active_fault(const FaultSetting& setting) {
  switch (setting.fault.kind) {
    case FaultKind::kCrash: return make_crash(setting);
    case FaultKind::kOmission: return make_omission(setting);
    case FaultKind::kBabblingIdiot: return make_babbling_idiot(setting);
    case FaultKind::kMasquerading: return make_masquerading(setting);
    case FaultKind::kSosTiming: return make_sos_timing(setting);
    case FaultKind::kSosValue: return make_sos_value(setting);
    case FaultKind::kBitFlipHeader:
    case FaultKind::kBitFlipPayload:
    case FaultKind::kBitFlipTrailer: return make_bit_flips(setting);
    case FaultKind::kChannelSwap: return make_channel_swap(setting);
    case FaultKind::kByzantineClock: return make_byzantine_clock(setting);
    case FaultKind::kDrift: return make_drift(setting);
    case FaultKind::kLoneColdstart: return make_lone_coldstart(setting);
    case FaultKind::kDuplicateColdstart:
      switch (setting.fault.duplicate) {
        case ttf::faults::DuplicateMode::kCas: return make_repeated_cas(setting);
        case ttf::faults::DuplicateMode::kStartupFrames: return make_rogue_startup(setting);
        case ttf::faults::DuplicateMode::kSameKeySlot: return make_wrong_schedule(setting);
      }
      break;
    case FaultKind::kWrongSchedule: return make_wrong_schedule(setting);
    case FaultKind::kNoise: return make_noise(setting);
    case FaultKind::kTransient: return make_transient(setting);
  }
  TTF_CHECK(false, "fault kind {}", static_cast<int>(setting.fault.kind));
}

}  // namespace ttf::sim::faults
