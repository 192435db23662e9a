#include "report/experiment/markdown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/counted.h"
#include "experiments/results/multiplicity.h"
#include "report/drawing/figures.h"
#include "report/experiment/interactions.h"

namespace ttf::report::experiment {
namespace {

using experiments::results::Family;
using experiments::results::Interval;

std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += ' ';
    for (const char c : cell) row += c == '|' ? std::string("\\|") : std::string(1, c);
    row += " |";
  }
  return row + '\n';
}

Interval difference_of(const Estimate& estimate) { return estimate.difference.value_or(Interval{}); }

// By point, then paradigm; the baseline's own are no numbers.
std::vector<Interval> differences(const ExperimentFolder& folder, std::size_t measure) {
  std::vector<Interval> all;
  for (const ExperimentPoint& point : folder.points)
    for (const auto& estimates : point.estimates) all.push_back(difference_of(estimates[measure]));
  return all;
}

std::string caption(const ExperimentFolder& folder, std::size_t m, const Family& family) {
  const ExperimentMeasure& measure = folder.measures[m];
  std::string text = measure.with_unit() + (measure.meaning.empty() ? "" : ": " + measure.meaning);
  text += fmt::format("; {:g} % intervals.", 100.0 * folder.confidence);
  if (family.comparisons > 0)
    text += fmt::format(" {} of {}, in bold, stay certain together by Holm's method at {:g} %.", family.certain,
                        counted(family.comparisons, "comparison"), std::round(1e6 * (1.0 - folder.confidence)) * 1e-4);
  return text + '\n';
}

std::string head_of(const std::vector<std::string>& header) {
  std::string text = row_of(header) + '|';
  for (std::size_t column = 0; column < header.size(); ++column) text += "---|";
  return text + '\n';
}

// The baseline's mean and the others' differences from it; along an axis, each paradigm's mean and its difference.
std::string table_of(const ExperimentFolder& folder, std::size_t m, const Family& family) {
  const bool along = !folder.compared_axis.empty();
  const auto has_mean = [&](std::size_t p) { return along || folder.paradigms[p] == folder.baseline; };
  const auto has_difference = [&](std::size_t p) { return along || folder.paradigms[p] != folder.baseline; };
  std::vector<std::string> header = folder.axes, differences_header;
  if (folder.axes.empty()) header.push_back("point");
  header.push_back("runs");
  for (std::size_t p = 0; p < folder.paradigms.size(); ++p) {
    if (has_mean(p)) header.push_back(folder.paradigms[p]);
    if (has_difference(p)) differences_header.push_back(folder.paradigms[p] + " - " + folder.baseline_name());
  }
  header.insert(header.end(), differences_header.begin(), differences_header.end());
  std::string text = head_of(header);
  std::size_t at = 0;
  for (const ExperimentPoint& point : folder.points) {
    std::vector<std::string> row = point.settings, means, compared;
    if (row.empty()) row.push_back(std::to_string(point.point));
    std::uint64_t runs = 0;
    for (std::size_t p = 0; p < folder.paradigms.size(); ++p, ++at) {
      const Estimate& estimate = point.estimates[p][m];
      runs = std::max(runs, estimate.mean.count);
      if (has_mean(p)) means.push_back(interval_words(estimate.mean));
      if (!has_difference(p)) continue;
      const Interval difference = difference_of(estimate);
      const std::string words = interval_words(difference, true);
      compared.push_back(family.stays[at] ? "**" + words + "**" : words);
    }
    row.push_back(std::to_string(runs));
    row.insert(row.end(), means.begin(), means.end());
    row.insert(row.end(), compared.begin(), compared.end());
    text += row_of(row);
  }
  return text;
}

}  // namespace

std::string markdown_tables(const ExperimentFolder& folder) {
  std::string text = folder.question + '\n';
  for (std::size_t m = 0; m < folder.measures.size(); ++m) {
    const Family family = experiments::results::family_of(differences(folder, m), folder.confidence);
    text += '\n' + caption(folder, m, family) + '\n' + table_of(folder, m, family);
  }
  for (const ExperimentInteraction& one : folder.interactions) {
    const page::PageTable table = interaction_table(folder, one, Marks::kBold);
    text += '\n' + table.caption + ".\n\n" + head_of(table.header);
    for (const std::vector<std::string>& row : table.rows) text += row_of(row);
  }
  return text;
}

}  // namespace ttf::report::experiment
