#include "cli/schedule/planning/command.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/output.h"
#include "cli/shipped.h"
#include "core/counted.h"
#include "core/errors.h"
#include "experiments/judges/error_judge.h"
#include "experiments/judges/gap_judge.h"
#include "report/drawing/render.h"
#include "report/plots/trade_off_picture.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/loader.h"
#include "schedules/synthesis/explanation/explain.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/loader.h"
#include "schedules/synthesis/plan/plan.h"
#include "schedules/synthesis/trade/binding.h"
#include "schedules/synthesis/trade/trade_off.h"
#include "sim/drives/step_catalog.h"

namespace ttf::cli::schedule::planning {
namespace {

namespace explanation = schedules::synthesis::explanation;
namespace instants = schedules::synthesis::instants;
namespace plans = schedules::synthesis::plan;
namespace trade = schedules::synthesis::trade;
using instants::Reached;
using instants::Synthesis;
using plans::Goal;
using plans::Plan;

// The judges of a plan's objectives that lie above schedules (experiments/judges).
class PlanJudges {
 public:
  explicit PlanJudges(const Plan& plan);
  PlanJudges(const PlanJudges&) = delete;
  PlanJudges& operator=(const PlanJudges&) = delete;

  const instants::judging::Judges& by_goal() const { return by_goal_; }

 private:
  std::optional<experiments::judges::ErrorJudge> error_;
  experiments::judges::GapJudge gap_error_;
  instants::judging::Judges by_goal_;
};

// A regret's part: a density and its errors.
struct Reference {
  double process_noise = 0.0;  // the density
  double least = 0.0;          // for it alone, as far as it was found [m^2]
  double error = 0.0;          // the error here [m^2]
};

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

PlanJudges::PlanJudges(const Plan& plan) : gap_error_(plan) {
  by_goal_[Goal::kGapError] = &gap_error_;
  if (plan.error) by_goal_[Goal::kError] = &error_.emplace(plan);
}

// Returns whether a judge counts the objective.
bool is_judged(Goal goal) { return goal == Goal::kError || goal == Goal::kGapError; }

// Returns a value of such an objective: m^2, or a ratio where it is a regret.
std::string judged_text(const Reached& one, double value) {
  return one.weights.size() > 1 ? fmt::format("{:.5f}", value) : square_metres(value);
}

// Returns what is known about it: proven best, or how far it may be off.
std::string judged_proof_text(const Reached& one) {
  if (!std::isfinite(one.value)) return "the loop was stable at no instants";
  if (one.bound <= 0.0) return "no bound is known";
  if (one.proven) return fmt::format("proven best: {}", one.way);
  if (one.value == one.bound) return fmt::format("best, if {}", one.supposes);
  const std::string off = fmt::format("at most {:.2g} % off", 100.0 * (one.value / one.bound - 1.0));
  return one.supposes.empty() ? off : fmt::format("{}, if {}", off, one.supposes);
}

// Returns them in the plan's order, for a regret; else none.
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

// Returns a line for each: the error, its ratio to the least one, and the difference.
std::string references_text(const std::vector<Reference>& references) {
  std::string text;
  for (const Reference& one : references)
    text += fmt::format("  with noise {:<9g}{:>12}{:>12}  {:.5f} times the least, {:.2g} m2 more\n", one.process_noise,
                        square_metres(one.error), "", one.error / one.least, difference(one));
  return text;
}

// Returns the weights of the plan's expected error; none if it has no such section, or a regret that is no objective.
std::vector<double> error_weights(const Plan& plan, const instants::Synthesis& made) {
  if (!plan.error) return {};
  for (const instants::Reached& one : made.reached)
    if (one.goal == Goal::kError && !one.weights.empty()) return one.weights;
  return plan.error->process_noises.size() == 1 ? std::vector<double>{1.0} : std::vector<double>{};
}

std::string csv_row(const Plan& plan, const char* kind, const trade::TradeOffPoint& point) {
  std::string row = fmt::format("{},{:g}", kind, in_ms(point.candidate.cycle));
  if (plan.payload) row += fmt::format(",{}", point.candidate.payload);
  for (std::size_t s = 0; s < plan.cluster.sensors.size(); ++s)
    row += fmt::format(",{}", point.candidate.repetitions[s]);
  row += fmt::format(",{:.3f},{:.3f},{},{},{},", in_ms(point.worst_age), in_ms(point.bound), point.slots,
                     point.fewest ? "proven" : "found", point.static_slots);
  return row + (point.judged ? fmt::format("{:.6g}\n", *point.judged) : "\n");
}

std::string csv(const Plan& plan, const trade::TradeOff& made) {
  std::string text = plan.payload ? "row,cycle_ms,payload_bytes" : "row,cycle_ms";
  for (const auto& sensor : plan.cluster.sensors) text += fmt::format(",{}_repetition", sensor.name);
  text += ",worst_age_ms,bound_ms,slots,fewest,static_slots,error\n";
  for (const trade::TradeOffPoint& point : made.candidates) text += csv_row(plan, "candidate", point);
  for (const trade::TradeOffPoint& point : made.front) text += csv_row(plan, "front", point);
  return text;
}

// Throws InputError if the name has no ending of a picture or a table.
void check_trade_off_path(const std::string& path) {
  for (const char* known : {".svg", ".png", ".pdf", ".csv"})
    if (path.ends_with(known)) return;
  throw InputError({"command line", 0, "--trade-off", path, "must end in .svg, .png, .pdf or .csv"});
}

// Writes candidates, the front of slots and ages, and in a picture what binds the schedule that was made.
void write_trade_off(const Plan& plan, const instants::Synthesis& made, const PlanJudges& judges,
                     const std::string& path) {
  trade::Judge judge;
  const std::vector<double> weights = error_weights(plan, made);
  if (!weights.empty())
    judge = [&](const schedules::model::Cluster& cluster) {
      return instants::judging::judged(*judges.by_goal().at(Goal::kError), weights, plan, cluster);
    };
  trade::TradeOff found = trade::trade_off(plan, judge);
  if (!found.complete)
    fmt::print(stderr, "note: the trade-off ends after {} placements: fewer slots may be possible\n", found.steps);
  if (path.ends_with(".csv")) {
    write_file(path, csv(plan, found));
  } else {
    const bool regret = weights.size() > 1;
    const report::plots::TradeOffView view{
        fmt::format("{}: what a smaller age costs, and what binds", plan.cluster.name), std::move(found),
        trade::what_binds(plan, made),
        weights.empty() ? "" : (regret ? "error: largest ratio to the least" : "expected squared error [m²]")};
    report::drawing::write_picture(report::plots::trade_off_svg(view), path);
  }
  say_written(path);
}

std::string value_text(const instants::Reached& one, double value) {
  const Goal goal = one.goal;
  if (is_judged(goal)) return judged_text(one, value);
  if (goal == Goal::kSlots) return fmt::format("{:.0f}", value);
  if (goal == Goal::kRoom) return fmt::format("{:.1f} %", 100.0 * value);
  return fmt::format("{:.3f} ms", value);
}

std::string proof_text(const instants::Reached& one) {
  if (is_judged(one.goal)) return judged_proof_text(one);
  if (one.proven) return fmt::format("proven best: {}", one.way);
  const double off = one.goal == Goal::kRoom ? one.bound - one.value : one.value - one.bound;
  return fmt::format("at most {} off", value_text(one, off));
}

std::string report(const Plan& plan, const Synthesis& made, const PlanJudges& judges) {
  const auto& cluster = made.cluster;
  std::vector<std::string> choices{"cycles", "rates"};
  if (plan.payload) choices.insert(choices.begin() + 1, "payloads");
  if (!plan.one_channel.empty()) choices.emplace_back("channels");
  const std::string payload = plan.payload ? fmt::format(" a payload of {} bytes,", made.candidate.payload) : "";
  std::string text = fmt::format("{}: a cycle of {:g} ms,{} chosen among {} {}\n", cluster.name, in_ms(cluster.cycle()),
                                 payload, made.candidates, joined(choices, " and "));
  text += fmt::format("{:<22}{:>12}{:>12}\n", "objective", "value", "bound");
  for (const instants::Reached& one : made.reached)
    text += fmt::format("{:<22}{:>12}{:>12}  {}\n{}", name_of(one.goal), value_text(one, one.value),
                        value_text(one, one.bound), proof_text(one),
                        references_text(references(plan, one, judges, cluster)));
  text += fmt::format("{:<22}{:>12}{:>12}{:>12}{:>12}\n", "chain [ms]", "best age", "worst age", "largest", "every");
  for (std::size_t c = 0; c < plan.chains.size(); ++c) {
    const plans::PlannedChain& chain = plan.chains[c];
    text +=
        fmt::format("{:<22}{:>12.3f}{:>12.3f}{:>12}{:>12.3f}\n", chain.name, in_ms(made.ages[c].best),
                    in_ms(made.ages[c].worst), chain.largest_age ? fmt::format("{:g}", in_ms(*chain.largest_age)) : "-",
                    in_ms(cluster.sensor(chain.from).period));
  }
  return text;
}

nlohmann::ordered_json report_json(const Plan& plan, const Synthesis& made, const PlanJudges& judges) {
  nlohmann::ordered_json json{{"cluster", made.cluster.name},
                              {"found", true},
                              {"cycle_ms", in_ms(made.cluster.cycle())},
                              {"candidates", made.candidates}};
  if (plan.payload) json["payload_bytes"] = made.candidate.payload;
  for (const instants::Reached& one : made.reached) {
    json["objective"].push_back(
        {{"name", name_of(one.goal)}, {"value", one.value}, {"bound", one.bound}, {"proven", one.proven}});
    if (one.proven) json["objective"].back()["way"] = one.way;
    if (!one.supposes.empty()) json["objective"].back()["supposes"] = one.supposes;
    for (const Reference& part : references(plan, one, judges, made.cluster))
      json["objective"].back()["least"].push_back({{"process_noise", part.process_noise},
                                                   {"error", part.least},
                                                   {"here", part.error},
                                                   {"more", part.error - part.least}});
  }
  for (std::size_t c = 0; c < plan.chains.size(); ++c)
    json["chains"].push_back({{"name", plan.chains[c].name},
                              {"age_ms", {in_ms(made.ages[c].best), in_ms(made.ages[c].worst)}},
                              {"period_ms", in_ms(made.cluster.sensor(plan.chains[c].from).period)}});
  return json;
}

std::string said(const explanation::Explanation::Said& one) {
  return one.line > 0 ? fmt::format("{}:{}: {}", one.file, one.line, one.text) : one.text;
}

int explain(const std::string& file, const Plan& plan, const Synthesis& made, bool json) {
  if (!made.refused.empty()) {
    std::vector<std::string> reasons;
    for (const Finding& finding : in_the_files(plan, made.refused)) reasons.push_back(finding.sentence());
    if (json)
      fmt::print("{}\n",
                 nlohmann::ordered_json{
                     {"cluster", plan.cluster.name}, {"found", false}, {"proven", false}, {"refused", reasons}}
                     .dump(2));
    return print_reasons(file, "no instants were found that pass the check", reasons);
  }
  const explanation::Explanation why = explanation::explain(plan);
  std::vector<std::string> core, changes;
  for (const auto& one : why.core) core.push_back(said(one));
  for (const auto& one : why.changes) changes.push_back(said(one));
  if (json)
    fmt::print("{}\n", nlohmann::ordered_json{{"cluster", plan.cluster.name},
                                              {"found", false},
                                              {"proven", why.proven},
                                              {"cannot_hold_together", core},
                                              {"one_change_is_enough", changes}}
                           .dump(2));
  if (core.empty())
    return print_reasons(file, "no solution was found, and dropping all that the plan says of instants does not help",
                         {"the lengths of the cycle allow no period for its sensors"});
  const int code = print_reasons(file,
                                 why.proven ? "has no solution: these statements cannot hold together"
                                            : "no solution was found with these statements together",
                                 core);
  if (!changes.empty()) print_reasons(file, "one of these changes alone is enough", changes);
  return code;
}

}  // namespace

int synthesize_plan(const std::string& typed, const PlanOutputs& outputs) {
  const std::string& out = outputs.cluster;
  const std::string file = file_named(typed, {kPlans});
  if (!out.empty()) refuse_overwriting(file, out, "--out");
  if (!outputs.trade_off.empty()) {
    refuse_overwriting(file, outputs.trade_off, "--trade-off");
    check_trade_off_path(outputs.trade_off);
  }
  const Plan plan = plans::load_plan(file);
  const PlanJudges judges(plan);
  const Synthesis made = instants::synthesize(plan, judges.by_goal());
  if (!made.found) return explain(file, plan, made, outputs.json);
  try {
    sim::drives::check_steps(made.cluster);
  } catch (const InputError& error) {
    throw InputError(in_the_files(plan, error.findings()));
  }
  const std::string text = report(plan, made, judges);
  if (!out.empty()) {
    const std::string name = std::filesystem::path(file).filename().string();
    const std::string yaml = schedules::exchange::cluster_yaml(
        made.cluster, fmt::format("Made from {} by `ttfusion schedule synthesize`.\n{}", name, text));
    schedules::file::parse_cluster(yaml, out);  // it can be read back
    write_file(out, yaml);
    say_written(out);
  }
  if (!outputs.trade_off.empty()) write_trade_off(plan, made, judges, outputs.trade_off);
  if (outputs.json)
    fmt::print("{}\n", report_json(plan, made, judges).dump(2));
  else
    fmt::print("{}{}", text,
               outputs.binding
                   ? schedules::synthesis::trade::binding_text(schedules::synthesis::trade::what_binds(plan, made))
                   : "");
  return 0;
}

}  // namespace ttf::cli::schedule::planning
