// Free time on a processor, and free static slots.
#pragma once

#include <optional>

#include "schedules/left_out/items.h"

namespace ttf::schedules::left_out {

// Return the first beginning at or after `from`, within one period, that no other item forbids; none if there is none. A task keeps
// off the tasks of its node that have an instant. A list has slots behind one another, which other frames have in other cycles.
std::optional<Ticks> free_on_processor(const Items& items, const Item& task, Ticks from);
std::optional<Ticks> free_slots(const model::Cluster& cluster, const List& list, Ticks slots, Ticks from);

}  // namespace ttf::schedules::left_out
