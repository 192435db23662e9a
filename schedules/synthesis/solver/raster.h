// The objective that is a function of the offsets: all offsets on a raster tried, or as many as the effort allows.
#pragma once

#include "schedules/synthesis/solver/decide.h"
#include "schedules/synthesis/solver/goal.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

// Changes `best` to offsets with the least value found; those of activities that do not move follow, where they must. The result is
// proven if all offsets of the raster were tried.
Reached least_on_raster(const Tightened& tightened, const Objective& objective, const Effort& effort, Decider& decider,
                        Solution& best);

}  // namespace ttf::schedules::synthesis::solver
