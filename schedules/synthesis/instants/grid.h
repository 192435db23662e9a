// Where one activity may begin: its grid, and the activities that stand on its resource.
#pragma once

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

// Returns a modulo b, not negative.
constexpr Ticks modulo(Ticks a, Ticks b) { return (a % b + b) % b; }

// Returns the latest beginning on the grid at or before `latest`.
Ticks latest_on_grid(const Grid& grid, Ticks latest);

// Returns the earliest beginning on the grid at or behind `earliest`.
Ticks next_on_grid(const Grid& grid, Ticks earliest);

// Returns by how much a beginning at `at` must be earlier (or later), so that the activity does not meet `other`, which begins
// at `there`; 0 if they do not meet.
Ticks in_the_way(const Activity& one, Ticks at, const Activity& other, Ticks there, bool earlier);

}  // namespace ttf::schedules::synthesis::instants
