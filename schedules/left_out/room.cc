#include "schedules/left_out/room.h"

#include <algorithm>
#include <numeric>

namespace ttf::schedules::left_out {
namespace {

constexpr Ticks modulo(Ticks a, Ticks b) { return (a % b + b) % b; }

// Returns the last of the slots that is taken.
std::optional<int> last_taken(const model::Cluster& cluster, const List& list, int base_cycle, int slot, int slots) {
  model::FrameSlot wanted;
  wanted.base_cycle = base_cycle;
  wanted.repetition = list.repetition;
  std::optional<int> last;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.slot < slot || frame.slot >= slot + slots || !share_a_channel(frame.channels, list.channels)) continue;
    if (share_a_cycle(frame, wanted)) last = std::max(last.value_or(0), frame.slot);
  }
  return last;
}

}  // namespace

std::optional<Ticks> free_on_processor(const Items& items, const Item& task, Ticks from) {
  Ticks start = from;
  for (bool moved = true; moved && start - from < task.period;) {
    moved = false;
    for (const Item& other : items.all) {
      if (&other == &task || other.place.kind != Place::Kind::kTask || other.place.task.node != task.place.task.node)
        continue;
      const std::optional<Ticks> begins = other.fixed ? other.fixed : other.at;
      if (!begins) continue;
      const Ticks common = std::gcd(task.period, other.period);
      const Ticks behind = modulo(start - *begins, common);
      if (behind < other.duration)
        start += other.duration - behind;
      else if (behind + task.duration > common)
        start += common - behind + other.duration;
      else
        continue;
      moved = true;
    }
  }
  return start - from < task.period ? std::optional(start) : std::nullopt;
}

std::optional<Ticks> free_slots(const model::Cluster& cluster, const List& list, Ticks slots, Ticks from) {
  const model::GlobalParameters& g = cluster.flexray;
  const Ticks last = last_slot(cluster) - slots + 1;
  const Ticks first_cycle = from / g.gMacroPerCycle;
  for (Ticks cycle = first_cycle; cycle <= first_cycle + list.repetition; ++cycle) {
    const Ticks begin = std::max<Ticks>(from - cycle * g.gMacroPerCycle, 0);
    Ticks slot = (begin + g.gdStaticSlot - 1) / g.gdStaticSlot + 1;
    while (slot <= last) {
      const auto taken = last_taken(cluster, list, static_cast<int>(cycle % list.repetition), static_cast<int>(slot),
                                    static_cast<int>(slots));
      if (!taken) return cycle * g.gMacroPerCycle + (slot - 1) * g.gdStaticSlot;
      slot = *taken + 1;
    }
  }
  return std::nullopt;
}

}  // namespace ttf::schedules::left_out
