// The room that a packing leaves in its slots: how far it can grow without a new one.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

struct Room {
  int node = 0;
  std::int64_t free_bits = 0;  // in all cycles, in the slots that the node has
  // The signals of the asked length that have room besides, if all of them have this repetition: for 1, 2, 4, ...,
  // cycles. Exact: signals of one repetition and one length do not hinder each other.
  std::vector<int> signals;
};

// Returns the room of each node, for signals in all variants. Where slots are shared, frames that no node owns count
// for each.
std::vector<Room> room_left(const Instance& instance, const Places& places, int bits);

}  // namespace ttf::schedules::packing
