#include "experiments/sweep/answers/answer_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/results/percent.h"
#include "experiments/sweep/answers/figures.h"
#include "experiments/sweep/answers/sentences.h"

namespace ttf::experiments::sweep::answers {
namespace {

constexpr std::size_t kWidest = 100;  // characters

struct Column {
  std::string head;
  std::vector<std::string> cells;
};

constexpr std::size_t kGap = 2;

std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::size_t width_of(const Column& column) {
  std::size_t width = shown_width(column.head);
  for (const std::string& cell : column.cells) width = std::max(width, shown_width(cell));
  return width;
}

std::size_t width_of(const std::vector<Column>& columns) {
  std::size_t width = 0;
  for (const Column& column : columns) width += kGap + width_of(column);
  return width;
}

std::string part_text(const std::vector<Column>& columns) {
  std::size_t rows = 0;
  for (const Column& column : columns) rows = std::max(rows, column.cells.size());
  std::vector<std::string> lines(rows + 1);
  for (const Column& column : columns) {
    const std::size_t width = width_of(column) + kGap;
    const auto add = [&](std::string& line, const std::string& cell) {
      line += cell + std::string(width - shown_width(cell), ' ');
    };
    add(lines[0], column.head);
    for (std::size_t r = 0; r < column.cells.size(); ++r) add(lines[r + 1], column.cells[r]);
  }
  std::string text;
  for (const std::string& line : lines) text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  return text;
}

// Returns a table, aligned left. A table wider than kWidest goes on below itself, each part with the leading columns. The
// columns of a group stay together unless they are too wide. All columns have as many cells.
std::string in_columns(const std::vector<Column>& leading, const std::vector<std::vector<Column>>& groups) {
  const std::size_t lead = width_of(leading);
  std::vector<std::vector<Column>> pieces;  // groups, or columns of those too wide
  for (const std::vector<Column>& group : groups) {
    if (lead + width_of(group) <= kWidest + kGap)
      pieces.push_back(group);
    else
      for (const Column& column : group) pieces.push_back({column});
  }
  std::string text;
  std::vector<Column> part = leading;
  const auto end_part = [&] { text += (text.empty() ? "" : "\n") + part_text(std::exchange(part, leading)); };
  for (const std::vector<Column>& piece : pieces) {
    if (part.size() > leading.size() && width_of(part) + width_of(piece) > kWidest + kGap) end_part();
    part.insert(part.end(), piece.begin(), piece.end());
  }
  end_part();
  return text;
}

// Returns the words in lines of at most kWidest characters, unless a word is longer.
std::string wrapped(std::string_view words) {
  std::string text, line;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    const std::string_view word = words.substr(0, end);
    words.remove_prefix(std::min(end + 1, words.size()));
    if (!line.empty() && shown_width(line) + 1 + shown_width(word) > kWidest) text += std::exchange(line, "") + '\n';
    line += (line.empty() ? "" : " ") + std::string(word);
  }
  return text + line + '\n';
}

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
      // Drives without a value are distinguished.
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
  return answer_lines(sweep, answer) + family_lines(sweep, answer) + lost_lines(sweep, answer);
}

std::string answer_text(const SweepFile& sweep, const SweepAnswer& answer) {
  const Measure& measure = *find_measure(sweep.measures.front());
  std::string text = sweep.question + "\n\n";
  if (const std::string lines = answer_lines(sweep, answer); !lines.empty()) text += lines + '\n';
  for (std::size_t i = 0; i < answer.interactions.size(); ++i)
    text += interaction_table(sweep, sweep.interactions[i], answer.interactions[i]) + '\n';
  text += wrapped(fmt::format("{}: {}; mean of the replications, {:g} % intervals", with_unit(measure), measure.meaning,
                              100.0 * sweep.confidence));
  text += measure_table(sweep, answer) + '\n' + family_lines(sweep, answer) + lost_lines(sweep, answer);
  if (answer.failed > 0) text += fmt::format("{} failed: see `status` in runs.csv\n", counted(answer.failed, "run"));
  for (const ExpectationAnswer& expectation : answer.expectations) {
    text += fmt::format("expected: {}: {}\n", expectation.text, to_text(expectation.outcome));
    for (const Unmet& unmet : expectation.unmet) text += fmt::format("  {}: {}\n", unmet.point, unmet.why);
  }
  return text;
}

}  // namespace ttf::experiments::sweep::answers
