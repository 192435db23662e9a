#include "report/experiment/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/csv.h"
#include "core/errors.h"

namespace ttf::report::experiment {
namespace {

constexpr std::size_t kValueColumns = 7;
constexpr std::size_t kMostCellsARow = 64;  // in the grid; most points need a row each
constexpr const char* kNameOfAFile = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

}  // namespace

std::optional<std::pair<double, std::string>> number_with_unit(const std::string& label) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  std::string unit(end, label.data() + label.size());
  if (!unit.empty() && unit.front() != ' ') return std::nullopt;
  if (!unit.empty()) unit.erase(0, 1);
  return std::pair(value, unit);
}

std::size_t NameList::place_of(const std::string& name) {
  const auto [place, added] = places_.try_emplace(name, names_.size());
  if (added) names_.push_back(name);
  return place->second;
}

ExperimentSummary read_summary(std::string_view text, const std::string& file) {
  const std::vector<std::string> values{
      "paradigm", "measure", "count", "mean", "half_width", "difference", "difference_half_width"};
  CsvLines lines(text);
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError({file, lines.line(), "", "", why});
  };
  const bool head = lines.next() && lines.broken().empty();
  const std::vector<std::string> names = head ? lines.fields() : std::vector<std::string>{};
  if (names.size() < 1 + kValueColumns || names[0] != "point" ||
      !std::equal(values.begin(), values.end(), names.end() - static_cast<std::ptrdiff_t>(kValueColumns)))
    throw refuse("must be the summary.csv of an experiment: point, its axes, paradigm, measure, count, mean, ...");
  ExperimentSummary summary;
  summary.axes.assign(names.begin() + 1, names.end() - static_cast<std::ptrdiff_t>(kValueColumns));
  NameList points, paradigms, measures;
  std::map<std::array<std::size_t, 3>, SummaryCell> cells;  // by point, measure and paradigm
  while (lines.next()) {
    const std::vector<std::string>& row = lines.fields();
    if (!lines.broken().empty()) throw refuse(std::string(lines.broken()));
    if (row.size() != names.size()) throw refuse(fmt::format("must have {} fields", names.size()));
    const std::size_t first = 1 + summary.axes.size();
    const auto value = [&](std::size_t column) {
      const std::string& field = row[first + column];
      if (field.empty()) return kAbsent;
      const auto number = number_with_unit(field);
      if (!number || !number->second.empty())
        throw InputError({file, lines.line(), values[column], field, "must be a number or empty"});
      return number->first;
    };
    const std::size_t point = points.place_of(row[0]);
    if (point == summary.points.size())
      summary.points.push_back({{row.begin() + 1, row.begin() + static_cast<std::ptrdiff_t>(first)}, {}});
    if (row[first + 1].empty() || row[first + 1].find_first_not_of(kNameOfAFile) != std::string::npos)
      throw InputError({file, lines.line(), "measure", row[first + 1], "must be letters, digits and underscores"});
    const std::size_t paradigm = paradigms.place_of(row[first]), measure = measures.place_of(row[first + 1]);
    const SummaryCell cell{value(3), value(4), value(5), value(6)};
    if (!cells.try_emplace({point, measure, paradigm}, cell).second)
      throw refuse("must be the only row of its point, paradigm and measure");
  }
  summary.paradigms = paradigms.names();
  summary.measures = measures.names();
  if (summary.points.empty()) throw refuse("must have a row: the experiment has no result yet");
  if (summary.points.size() > kMostCellsARow * cells.size() / (summary.measures.size() * summary.paradigms.size()))
    throw InputError({file, 0, "", "", "must have a row for each point, paradigm and measure"});
  for (SummaryPoint& point : summary.points)
    point.cells.assign(summary.measures.size(), std::vector<SummaryCell>(summary.paradigms.size()));
  for (const auto& [place, cell] : cells) summary.points[place[0]].cells[place[1]][place[2]] = cell;
  return summary;
}

}  // namespace ttf::report::experiment
