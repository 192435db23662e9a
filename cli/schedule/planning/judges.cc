#include "cli/schedule/planning/judges.h"

#include <fmt/format.h>

#include <cmath>

namespace ttf::cli::schedule::planning {

using schedules::synthesis::instants::Reached;
using schedules::synthesis::plan::Goal;
using schedules::synthesis::plan::Plan;

PlanJudges::PlanJudges(const Plan& plan) : gap_error_(plan) {
  by_goal_[Goal::kGapError] = &gap_error_;
  if (plan.error) by_goal_[Goal::kError] = &error_.emplace(plan);
}

bool is_judged(Goal goal) { return goal == Goal::kError || goal == Goal::kGapError; }

namespace {

// In twelve columns, with a space before it.
std::string square_metres(double value) {
  if (!std::isfinite(value)) return "unbounded";
  return fmt::format("{:.{}g} m2", value, value < 1e-3 ? 3 : 4);
}

}  // namespace

std::string judged_text(const Reached& one, double value) {
  return one.weights.size() > 1 ? fmt::format("{:.5f}", value) : square_metres(value);
}

std::string judged_proof_text(const Reached& one) {
  if (!std::isfinite(one.value)) return "the loop was stable at no instants";
  if (one.bound <= 0.0) return "no bound is known";
  if (one.proven) return fmt::format("proven best: {}", one.way);
  if (one.value == one.bound) return fmt::format("best, if {}", one.supposes);
  const std::string off = fmt::format("at most {:.2g} % off", 100.0 * (one.value / one.bound - 1.0));
  return one.supposes.empty() ? off : fmt::format("{}, if {}", off, one.supposes);
}

std::string references_text(const Plan& plan, const Reached& one) {
  std::string text;
  if (one.weights.size() < 2) return text;
  for (std::size_t i = 0; i < one.weights.size(); ++i)
    text +=
        fmt::format("  least of {:<11g}{:>12}\n", plan.error->process_noises[i], square_metres(1.0 / one.weights[i]));
  return text;
}

}  // namespace ttf::cli::schedule::planning
