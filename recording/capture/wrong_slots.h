// Which captured frames were sent in another slot than the one whose id they bear. Private to the room.
//
// The header says a frame's slot, its stamp when it was there. Less its slot's offset in the cycle, the stamps of all
// static frames are a whole number of cycles apart; one that is off by more than half a slot was in another slot.
// That is as good as the stamps are: it is said only where the frames around it vouch for them, which they do when they
// are themselves, nearly all, well inside their slots. Coarse, jittered or patched up stamps thus say nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::recording::capture {

// By its stamp and by its header.
struct StampedFrame {
  std::int64_t time_ns = 0;
  int slot = 0;
  schedules::model::Channel channel{};
};

// For every frame, in the order of time, where it was if not in its slot: a static slot, or gNumberOfStaticSlots + 1,
// which is anywhere outside of the static segment. Nothing for a frame that was in its slot, or where the stamps do not
// tell. A dynamic frame has no place to be, but the static segment is a wrong one. The capture's clock may run off the
// cluster's by what two clocks may differ.
//
// Laws
//   S1  A frame whose stamp is within half a slot of its place is never in a wrong slot.
//   S2  Neither is one that has another frame of its channel within half a slot: both were not there at once, so that
//       it is the stamp that is wrong.
//   S3  Of the frames of other slots that are next to it, up to kWitnesses before and as many after, not more than two
//       cycles away, there are kLeastWitnesses at least, and three in four agree to a tenth of a slot. Those are of two
//       slots at least: of two senders alone, either may be in the wrong.
std::vector<std::optional<int>> frames_in_wrong_slots(const schedules::model::GlobalParameters& flexray,
                                                      std::span<const StampedFrame> frames);
inline constexpr std::size_t kWitnesses = 16, kLeastWitnesses = 8;

}  // namespace ttf::recording::capture
