// Tasks of a time-triggered table: each begins at offset + k * period and has the resource alone for its worst case.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "core/time.h"

namespace ttf::schedules::timing::task_set {

struct TableEntry {
  Duration period{}, offset{}, worst{};
};

// Returns the first pair of entries of which some jobs overlap; an entry with itself, if it is longer than its period.
// Jobs of a and b begin at distances d + k g, with d = (offset_b - offset_a) mod g and g the greatest common divisor of
// the periods. So they never overlap if d >= worst_a and g - d >= worst_b.
std::optional<std::pair<std::size_t, std::size_t>> overlap_in(std::span<const TableEntry> table);

}  // namespace ttf::schedules::timing::task_set
