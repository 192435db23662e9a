#include "cli/schedule/planning/trade_off.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "cli/output.h"
#include "core/errors.h"
#include "report/drawing/render.h"
#include "report/plots/trade_off_picture.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/trade/binding.h"
#include "schedules/synthesis/trade/trade_off.h"

namespace ttf::cli::schedule::planning {
namespace {

namespace instants = schedules::synthesis::instants;
namespace trade = schedules::synthesis::trade;
using schedules::synthesis::plan::Goal;
using schedules::synthesis::plan::Plan;

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

}  // namespace

void check_trade_off_path(const std::string& path) {
  for (const char* known : {".svg", ".png", ".pdf", ".csv"})
    if (path.ends_with(known)) return;
  throw InputError({"command line", 0, "--trade-off", path, "must end in .svg, .png, .pdf or .csv"});
}

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

}  // namespace ttf::cli::schedule::planning
