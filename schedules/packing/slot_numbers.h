// The numbers of slots, and the channels on which they are sent.
//
// On two channels with the same content each slot is sent on both, so a packing of one channel serves. Independent
// channels: a slot number on A and the same one on B are two bins, which may belong to different nodes. All nodes are
// attached to both channels. So the bins of one channel are dealt out in turn, and the fuller channel has half of them,
// rounded up. These are the fewest if the bins are.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::packing {

enum class ChannelUse : std::uint8_t { kOne, kSame, kIndependent };

struct SlotNumber {
  int slot = 0;
  model::Channels channels = model::Channels::kA;  // kAB for kSame, else one

  bool operator==(const SlotNumber&) const = default;
};

// Returns the numbers of all bins. The first ones have the numbers that `fixed` says. The others take the lowest free
// number from `first_slot` on; of independent channels, on the one with fewer slots.
std::vector<SlotNumber> slot_numbers(std::vector<SlotNumber> fixed, int bins, int first_slot, ChannelUse use);

// Returns the slots in use on a channel.
int slots_on(const std::vector<SlotNumber>& numbers, model::Channel channel);

}  // namespace ttf::schedules::packing
