// The frames of a packing: slot, base cycle and repetition, as FlexRay controllers and bus descriptions have them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "schedules/packing/check.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

// A frame with the same signals in each of its cycles.
struct PackedFrame {
  SlotNumber number;
  int base_cycle = 0;
  int repetition = 1;
  int node = 0;
  std::vector<std::size_t> signals;  // in the order of their bits
};

// Returns the fewest frames whose repetitions are powers of two, by slot, channel and base cycle. The packing must pass
// check.h. A slot with one owner has a frame in every cycle, some of them without signals: its owner sends it all the
// same.
std::vector<PackedFrame> frames_of(const Instance& instance, const Assignment& assignment);

// Adds a slot without signals for each node with no slot that has the same frame in every cycle: a controller needs
// one, its key slot. The new slots take the lowest numbers that are free on all channels.
//
// The vehicles are those of several variants, each with its frames: a node has the same key slot in all of them, and
// a new slot is free in all that have the node. Returns the key slots by node.
std::map<int, int> add_key_slots(std::vector<std::vector<PackedFrame>>& vehicles);

// Returns the slot of a node that has the same frame in every cycle: the lowest one. None without such a slot.
std::optional<int> key_slot(const std::vector<PackedFrame>& frames, int node);

}  // namespace ttf::schedules::packing
