#include <fmt/format.h>

#include <cmath>

#include "experiments/sweep/answers/answer_text.h"

namespace ttf::experiments::sweep::answers {
namespace {

using results::Interval;

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

}  // namespace ttf::experiments::sweep::answers
