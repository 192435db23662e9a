// `schedule synthesize PLAN.yaml`: a cluster from a plan (schedules/synthesis/plan).
#pragma once

#include <string>

namespace ttf::cli::schedule::planning {

struct PlanOutputs {
  std::string cluster;    // the file to write; empty: none
  std::string trade_off;  // likewise, a picture or a table
  bool binding = false;   // prints what binds
  bool json = false;
};

// Writes the files, and prints the objectives' values with their bounds. A plan without a solution is explained, statement by
// statement. Returns the exit code: 1 without a solution.
int synthesize_plan(const std::string& plan, const PlanOutputs& outputs);

}  // namespace ttf::cli::schedule::planning
