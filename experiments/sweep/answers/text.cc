#include "experiments/sweep/answers/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/results/percent.h"
#include "experiments/sweep/answers/columns.h"
#include "experiments/sweep/answers/figures.h"
#include "experiments/sweep/answers/sentences.h"

namespace ttf::experiments::sweep::answers {
namespace {

using evaluation::measures::find_measure;
using evaluation::measures::Measure;

std::string with_unit(const Measure& measure) {
  return measure.unit.empty() ? std::string(measure.name) : fmt::format("{} [{}]", measure.name, measure.unit);
}

// The axes' values at some points; `without` one axis.
std::vector<Column> axis_columns(const SweepFile& sweep, const std::vector<std::uint32_t>& points,
                                 std::optional<std::size_t> without = std::nullopt) {
  const std::vector<const Axis*> grid = sweep.grid();
  std::vector<Column> columns;
  for (std::size_t a = 0; a < grid.size(); ++a) {
    if (a == without) continue;
    Column& column = columns.emplace_back(Column{grid[a]->name, {}});
    for (const std::uint32_t point : points) column.cells.push_back(sweep.settings_of(point)[a]->label);
  }
  return columns;
}

// The difference of a paradigm, and its ratio as a change in per cent where some point has one.
std::vector<Column> difference_columns(const SweepFile& sweep, const SweepAnswer& answer, std::size_t p) {
  const std::string& name = sweep.paradigms[p].name;
  const std::string against =
      sweep.compared_axis ? sweep.grid()[sweep.compared_axis->axis]->settings[sweep.compared_axis->baseline].label
                          : sweep.paradigms[sweep.baseline].name;
  std::vector<Column> group{
      {sweep.compared_axis ? fmt::format("{}, minus {}", name, against) : name + " - " + against, {}},
      {"% of " + against, {}}};
  bool any = false;
  for (const PointAnswer& point : answer.points) {
    const results::Interval& difference = point.differences[p].front();
    const results::Ratio& ratio = point.ratios[p].front();
    const bool compared = sweep.reference_of(point.point, p).has_value();
    group[0].cells.push_back(compared ? fmt::format("{} {}{}", interval_text(difference, true), verdict(difference),
                                                    point.stays[p] ? "*" : "")
                                      : "-");
    any = any || !std::isnan(ratio.low);
    std::string change = std::isnan(ratio.low) ? "-" : percent_text(ratio);
    change.erase(std::remove(change.begin(), change.end(), '%'), change.end());
    if (const std::size_t gap = change.find("  "); gap != std::string::npos) change.erase(gap, 1);
    group[1].cells.push_back(std::move(change));
  }
  if (!any) group.pop_back();
  return group;
}

std::string measure_table(const SweepFile& sweep, const SweepAnswer& answer) {
  std::vector<std::uint32_t> points;
  std::vector<std::uint64_t> most_runs;
  Column runs{"runs", {}};
  for (const PointAnswer& point : answer.points) {
    points.push_back(point.point);
    std::uint64_t& most = most_runs.emplace_back(0);
    for (const auto& means : point.means) most = std::max(most, means.front().count);
    runs.cells.push_back(std::to_string(most));
  }
  std::vector<std::vector<Column>> groups{{std::move(runs)}};
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p) {
    Column& means = groups.emplace_back().emplace_back(Column{sweep.paradigms[p].name, {}});
    for (std::size_t i = 0; i < answer.points.size(); ++i) {
      const results::Interval& mean = answer.points[i].means[p].front();
      means.cells.push_back(interval_text(mean, false));
      // Drives without a value are told apart.
      if (mean.count > 0 && mean.count < most_runs[i]) means.cells.back() += fmt::format(" of {}", mean.count);
    }
  }
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    if (sweep.compared_axis || p != sweep.baseline) groups.push_back(difference_columns(sweep, answer, p));
  return in_columns(axis_columns(sweep, points), groups);
}

std::string interaction_table(const SweepFile& sweep, const Interaction& of, const InteractionAnswer& answer) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  std::vector<std::uint32_t> points;
  Column runs{"runs", {}}, one{first, {}}, other{second, {}}, both{fmt::format("{} against {}", first, second), {}};
  for (const InteractionPoint& here : answer.points) {
    points.push_back(here.point);
    runs.cells.push_back(std::to_string(here.interaction.count));
    one.cells.push_back(change_effect(sweep, of, here.first));
    other.cells.push_back(change_effect(sweep, of, here.second));
    both.cells.push_back(
        fmt::format("{} {}{}", interaction_effect(sweep, of, here), verdict(here.interaction), here.stays ? "*" : ""));
  }
  return wrapped(fmt::format("{} of {} and {}, {}: {}; {:g} % intervals",
                             with_unit(*find_measure(sweep.measures[of.measure])), first, second,
                             change_name(sweep, of), results::interaction_columns(of.scale == Scale::kRatio),
                             100.0 * sweep.confidence)) +
         in_columns(axis_columns(sweep, points, of.axis), {{runs}, {one}, {other}, {both}});
}

}  // namespace

std::string answer_sentences(const SweepFile& sweep, const SweepAnswer& answer) {
  return answer_lines(sweep, answer) + family_lines(sweep, answer);
}

std::string answer_text(const SweepFile& sweep, const SweepAnswer& answer) {
  const Measure& measure = *find_measure(sweep.measures.front());
  std::string text = sweep.question + "\n\n";
  if (const std::string lines = answer_lines(sweep, answer); !lines.empty()) text += lines + '\n';
  for (std::size_t i = 0; i < answer.interactions.size(); ++i)
    text += interaction_table(sweep, sweep.interactions[i], answer.interactions[i]) + '\n';
  text += wrapped(fmt::format("{}: {}; mean of the replications, {:g} % intervals", with_unit(measure), measure.meaning,
                              100.0 * sweep.confidence));
  text += measure_table(sweep, answer) + '\n' + family_lines(sweep, answer);
  if (answer.failed > 0) text += fmt::format("{} failed: see `status` in runs.csv\n", counted(answer.failed, "run"));
  for (const ExpectationAnswer& expectation : answer.expectations) {
    text += fmt::format("expected: {}: {}\n", expectation.text, to_text(expectation.outcome));
    for (const Unmet& unmet : expectation.unmet) text += fmt::format("  {}: {}\n", unmet.point, unmet.why);
  }
  return text;
}

}  // namespace ttf::experiments::sweep::answers
