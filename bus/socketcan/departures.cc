#include "bus/socketcan/departures.h"

#include <algorithm>

namespace ttf::bus::socketcan {

void Departures::expect(const canfd_frame& last, int slot, std::uint8_t cycle_counter, ports::MachineTime due) {
  Departure& departure = ring_[next_];
  if (!departure.expected) ++expected_;
  departure = {.expected = true, .last = last, .slot = slot, .cycle_counter = cycle_counter, .due = due};
  next_ = (next_ + 1) % kRoom;
}

std::optional<FollowUp> Departures::left(const canfd_frame& can, ports::MachineTime at) {
  // The oldest first. The driver may have changed the flags, so they are not compared.
  for (std::size_t i = 0; i < kRoom && expected_ > 0; ++i) {
    Departure& departure = ring_[(next_ + i) % kRoom];
    if (!departure.expected || departure.last.can_id != can.can_id || departure.last.len != can.len ||
        !std::equal(can.data, can.data + std::min<std::size_t>(can.len, CANFD_MAX_DLEN), departure.last.data))
      continue;
    departure.expected = false;
    --expected_;
    const Duration late = at - departure.due;
    if (!fits_follow_up(late)) return {};
    return FollowUp{.slot = departure.slot, .cycle_counter = departure.cycle_counter, .late = late};
  }
  return {};
}

}  // namespace ttf::bus::socketcan
