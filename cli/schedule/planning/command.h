// `schedule synthesize PLAN.yaml`: a cluster from a plan (schedules/synthesis/plan).
#pragma once

#include <string>

namespace ttf::cli::schedule::planning {

// Writes the cluster to `out` (nothing, if it is empty) and prints the objectives' values with their bounds. A plan without a
// solution is explained, statement by statement. Returns the exit code: 1 without a solution.
int synthesize_plan(const std::string& plan, const std::string& out, bool json);

}  // namespace ttf::cli::schedule::planning
