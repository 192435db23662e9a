// The exact solver (solver/solve.h) settles questions that the search (placement.h) leaves open.
//
// The solver is given a relaxation of the plan's problem, so its bounds hold for the plan as well:
//
//   offsets      as they are, but precedences are left out: from any offsets, data passes to the next beginning behind its gap,
//                and the ages along chains count that wait
//   chains       those of one period. Where periods differ, an age here is that of the oldest measurement on its way, and the
//                solver's is that of the oldest output
//   order        of lists that one node fuses (Plan::in_order), where a chain of one period leads from both sensors
//
// Its offsets are taken if they also keep what was left out.
#pragma once

#include <optional>
#include <string>

#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/solver/prover.h"

namespace ttf::schedules::synthesis::instants {

struct Settled {
  std::optional<Placed> best;  // within the limits
  bool none = false;           // no placement is within the limits
  bool open = true;            // neither that is proven, nor that `best` is the best
  Ticks bound = 0;             // no placement within the limits has a smaller worst age; if there is none: beyond them
  std::string way;             // the solver's way to the proof (solver/solve.h)
};

// Looks for the least worst age within the limits, with `any` for any placement. `prover` may be null.
Settled settle(const Reading& reading, const Limits& limits, solver::Prover* prover, bool any = false);

// Returns the problem that the solver is given; none if it makes no sense there (checker.h). Ages end with the last activity.
std::optional<Problem> relaxed(const Reading& reading, const Limits& limits);

}  // namespace ttf::schedules::synthesis::instants
