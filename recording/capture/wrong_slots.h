// Finds captured frames that were sent outside the slot of their id. Private to the module.
//
// The header gives a frame's slot, the stamp its instant. Minus their slots' offsets in the cycle, the stamps
// of static frames are whole cycles apart. A frame that is off by more than half a slot was in another slot.
// The stamps must be good enough for this: nearly all frames around it, its witnesses, must be well inside
// their slots. Coarse, jittered or repaired stamps yield no judgement.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::recording::capture {

// A frame's stamp, and its place by its header.
struct StampedFrame {
  std::int64_t time_ns = 0;
  int slot = 0;
  schedules::model::Channel channel{};
};

// Returns for every frame the slot that it was in, if that is not its own: a static slot, or
// gNumberOfStaticSlots + 1 for any place outside the static segment. Absent for a frame in its own slot, and
// where the stamps allow no judgement. A dynamic frame has no fixed place, but it is wrong in the static
// segment. `frames` are in the order of time. The capture's clock may drift against the cluster's as any two
// clocks may.
//
// Laws
//   S1  A frame whose stamp is within half a slot of its place is never in a wrong slot.
//   S2  A frame within half a slot of another frame of its channel is never in a wrong slot: two frames cannot overlap,
//       so the stamp is wrong.
//   S3  Witnesses are frames of other slots: up to kWitnesses before the frame and as many after it, at most two cycles
//       away. At least kLeastWitnesses are needed, and three in four must agree to a tenth of a slot. Those that agree
//       must be of at least two slots: of two senders alone, either may be wrong.
std::vector<std::optional<int>> frames_in_wrong_slots(const schedules::model::GlobalParameters& flexray,
                                                      std::span<const StampedFrame> frames);
inline constexpr std::size_t kWitnesses = 16, kLeastWitnesses = 8;

}  // namespace ttf::recording::capture
