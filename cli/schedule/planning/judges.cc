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

// Rounding makes no difference.
double difference(const Reference& one) {
  const double more = one.error - one.least;
  return more <= 1e-9 * one.least ? 0.0 : more;
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

std::vector<Reference> references(const Plan& plan, const Reached& one, const PlanJudges& judges,
                                  const schedules::model::Cluster& made) {
  std::vector<Reference> found;
  if (one.weights.size() < 2) return found;
  for (std::size_t i = 0; i < one.weights.size(); ++i) {
    std::vector<double> alone(one.weights.size(), 0.0);
    alone[i] = 1.0;
    const double error =
        schedules::synthesis::instants::judging::judged(*judges.by_goal().at(one.goal), alone, plan, made);
    found.push_back({plan.error->process_noises[i], 1.0 / one.weights[i], error});
  }
  return found;
}

std::string references_text(const std::vector<Reference>& references) {
  std::string text;
  for (const Reference& one : references)
    text += fmt::format("  with noise {:<9g}{:>12}{:>12}  {:.5f} times the least, {:.2g} m2 more\n", one.process_noise,
                        square_metres(one.error), "", one.error / one.least, difference(one));
  return text;
}

}  // namespace ttf::cli::schedule::planning
