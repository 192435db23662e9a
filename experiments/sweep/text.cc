#include "experiments/sweep/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "experiments/sweep/measures.h"

namespace ttf::experiments::sweep {
namespace {

using results::Interval;

std::string_view verdict(const Interval& difference) {
  return difference.below(0.0) ? "less" : difference.above(0.0) ? "more" : "undecided";
}

std::string padded(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths.resize(std::max(widths.size(), c + 1));
      widths[c] = std::max(widths[c], row[c].size());
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format("{:<{}}", row[c], widths[c] + 2);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string axis_columns(const SweepFile& sweep) {
  std::string columns;
  for (const Axis* axis : sweep.grid()) columns += quoted(axis->name) + ',';
  return columns;
}
std::string axis_cells(const SweepFile& sweep, std::uint32_t point) {
  std::string cells;
  for (const Setting* setting : sweep.settings_of(point)) cells += quoted(setting->label) + ',';
  return cells;
}

}  // namespace

std::string answer_sentences(const SweepFile& sweep, const SweepAnswer& answer) {
  const std::string& baseline = sweep.paradigms[sweep.baseline].name;
  std::string text;
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p) {
    if (p == sweep.baseline) continue;
    int less = 0, more = 0, undecided = 0;
    for (const PointAnswer& point : answer.points) {
      const Interval& difference = point.differences[p].front();
      ++(difference.below(0.0) ? less : difference.above(0.0) ? more : undecided);
    }
    text += fmt::format("{} of {} is less than that of {} at {}, more at {}, undecided at {}.\n",
                        sweep.measures.front(), sweep.paradigms[p].name, baseline,
                        counted(static_cast<std::uint64_t>(less), "point"), more, undecided);
    for (const Crossing& crossing : answer.crossings)
      if (crossing.paradigm == p && crossing.certain)
        text += fmt::format("They cross at {} {:.4g}{}.\n", crossing.axis, crossing.at,
                            crossing.others.empty() ? "" : ", with " + crossing.others);
  }
  if (answer.comparisons > 0)
    text += fmt::format(
        "{} of {}, marked *, stay certain together by Holm's method at {:g} %; each interval stands for "
        "itself.\n",
        answer.certain, counted(answer.comparisons, "comparison"), std::round(1e6 * (1.0 - sweep.confidence)) * 1e-4);
  return text;
}

std::string answer_text(const SweepFile& sweep, const SweepAnswer& answer) {
  const Measure& measure = *find_measure(sweep.measures.front());
  std::string text = sweep.question + '\n';
  text += fmt::format("\n{}{}: {}; mean of the replications, {:g} % intervals\n", measure.name,
                      measure.unit.empty() ? "" : fmt::format(" [{}]", measure.unit), measure.meaning,
                      100.0 * sweep.confidence);
  std::vector<std::vector<std::string>> rows(1);
  for (const Axis* axis : sweep.grid()) rows[0].push_back(axis->name);
  rows[0].push_back("runs");
  for (const Paradigm& paradigm : sweep.paradigms) rows[0].push_back(paradigm.name);
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    if (p != sweep.baseline)
      rows[0].push_back(fmt::format("{} - {}", sweep.paradigms[p].name, sweep.paradigms[sweep.baseline].name));
  for (const PointAnswer& point : answer.points) {
    std::vector<std::string> row;
    for (const Setting* setting : sweep.settings_of(point.point)) row.push_back(setting->label);
    std::uint64_t most = 0;
    for (const auto& means : point.means) most = std::max(most, means.front().count);
    row.push_back(std::to_string(most));
    for (const auto& means : point.means) row.push_back(interval_text(means.front(), false));
    for (std::size_t p = 0; p < point.differences.size(); ++p)
      if (p != sweep.baseline)
        row.push_back(fmt::format("{} {}{}", interval_text(point.differences[p].front(), true),
                                  verdict(point.differences[p].front()), point.stays[p] ? "*" : ""));
    rows.push_back(std::move(row));
  }
  text += padded(rows) + '\n' + answer_sentences(sweep, answer);
  if (answer.failed > 0) text += fmt::format("{} failed: see `status` in runs.csv\n", counted(answer.failed, "run"));
  for (const ExpectationAnswer& expectation : answer.expectations) {
    text += fmt::format("expected: {}: {}\n", expectation.text, words(expectation.outcome));
    for (const Unmet& unmet : expectation.unmet) text += fmt::format("  {}: {}\n", unmet.point, unmet.why);
  }
  return text;
}

std::string summary_csv(const SweepFile& sweep, const SweepAnswer& answer) {
  std::string csv =
      "point," + axis_columns(sweep) + "paradigm,measure,count,mean,half_width,difference,difference_half_width\n";
  for (const PointAnswer& point : answer.points)
    for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
      for (std::size_t m = 0; m < sweep.measures.size(); ++m) {
        const Interval& mean = point.means[p][m];
        const Interval& difference = point.differences[p][m];
        csv += fmt::format("{},{}{},{},{},{},{},{},{}\n", point.point, axis_cells(sweep, point.point),
                           sweep.paradigms[p].name, sweep.measures[m], mean.count, cell(mean.mean),
                           cell(mean.half_width), cell(difference.mean), cell(difference.half_width));
      }
  return csv;
}

std::string runs_csv(const SweepFile& sweep, const results::Store& store) {
  std::string csv = "point," + axis_columns(sweep) + "replication,paradigm,status";
  for (const std::string& measure : store.head().measures) csv += ',' + quoted(measure);
  csv += '\n';
  store.for_each([&](const results::Row& row) {
    csv += fmt::format("{},{}{},{},{}", row.key.point, axis_cells(sweep, row.key.point), row.key.replication,
                       sweep.paradigms[row.key.paradigm].name, quoted(row.status));
    for (const double value : row.values) csv += ',' + cell(value);
    csv += '\n';
  });
  return csv;
}

}  // namespace ttf::experiments::sweep
