// Checks a packing, by rules alone: it shares no code with the search. Every packing passes it before it is written,
// and so do the places that stand.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "schedules/packing/instance.h"
#include "schedules/packing/slot_numbers.h"

namespace ttf::schedules::packing {

// The place of a signal on the bus.
struct Assigned {
  SlotNumber number;
  int first_cycle = 0;
  int offset = 0;

  bool operator==(const Assigned&) const = default;
};
// By signal; a signal without an entry has no place.
using Assignment = std::vector<std::optional<Assigned>>;

Assignment assigned(const Places& places, const std::vector<SlotNumber>& numbers);

struct Violation {
  std::size_t signal = 0;
  std::string text;  // "must ..." or "overlaps ...", to be read behind the signal's name
};

// Returns the broken rules in the order of signals, each signal with its first one:
//   the slot is 0..kLastStaticSlot, the first cycle within the signal's window, and the bits within the frame;
//   no bit of a frame has two signals;
//   a slot has one owner on a channel; a frame has, where slots are shared.
std::vector<Violation> violations(const Instance& instance, const Assignment& assignment);

}  // namespace ttf::schedules::packing
