// The judges of a plan's objectives that lie above schedules (experiments/judges).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/judges/error_judge.h"
#include "experiments/judges/gap_judge.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::cli::schedule::planning {

class PlanJudges {
 public:
  explicit PlanJudges(const schedules::synthesis::plan::Plan& plan);
  PlanJudges(const PlanJudges&) = delete;
  PlanJudges& operator=(const PlanJudges&) = delete;

  const schedules::synthesis::instants::judging::Judges& by_goal() const { return by_goal_; }

 private:
  std::optional<experiments::judges::ErrorJudge> error_;
  experiments::judges::GapJudge gap_error_;
  schedules::synthesis::instants::judging::Judges by_goal_;
};

// Returns whether a judge counts the objective.
bool is_judged(schedules::synthesis::plan::Goal goal);

// Returns a value of such an objective: m^2, or a ratio where it is a regret.
std::string judged_text(const schedules::synthesis::instants::Reached& one, double value);

// Returns what is known about it: proven best, or how far it may be off.
std::string judged_proof_text(const schedules::synthesis::instants::Reached& one);

// A regret's part: a density and its errors.
struct Reference {
  double process_noise = 0.0;  // the density
  double least = 0.0;          // for it alone, as far as it was found [m^2]
  double error = 0.0;          // the error here [m^2]
};

// Returns them in the plan's order, for a regret; else none.
std::vector<Reference> references(const schedules::synthesis::plan::Plan& plan,
                                  const schedules::synthesis::instants::Reached& one, const PlanJudges& judges,
                                  const schedules::model::Cluster& made);

// Returns a line for each: the error, its ratio to the least one, and the difference.
std::string references_text(const std::vector<Reference>& references);

}  // namespace ttf::cli::schedule::planning
