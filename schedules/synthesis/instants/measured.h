// The result as `schedule check` bounds it, held against the ages that the instants alone make.
#pragma once

#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/synthesize.h"

namespace ttf::schedules::synthesis::instants {

// Bounds of the check that are above those of the instants have a cause beyond them: a task that holds lists. The proof is then
// about the rest.
struct Measured {
  Duration worst{}, data{}, jitter{}, beyond{};
};

// Bounds the ages of a cluster that passed the check, and notes them by chain.
Measured measure(const plan::Plan& plan, const Placed& placed, Synthesis& made);

// Returns findings about ages above the plan's largest.
std::vector<Finding> too_old(const plan::Plan& plan, const Synthesis& made);

// Returns what was reached without candidates that the check refused, held against the bounds of all candidates: others of their
// instants might pass. Both have the same objectives.
std::vector<Reached> bounded_by(std::vector<Reached> reached, const std::vector<Reached>& of_all);

// Returns values and bounds in milliseconds where they are in ticks.
std::vector<Reached> in_units(std::vector<Reached> reached, const Measured& measured, const model::Cluster& cluster);

}  // namespace ttf::schedules::synthesis::instants
