#include "report/experiment/interactions.h"

#include <fmt/format.h>

#include <cmath>

#include "report/drawing/figures.h"

namespace ttf::report::experiment {
namespace {

std::string change_text(const ExperimentChange& change) {
  if (!change.percent) return drawing::with_interval(change.difference.mean, change.difference.half_width, true);
  const experiments::results::Ratio& percent = *change.percent;
  if (std::isnan(percent.value)) return "-";
  const std::string value = fmt::format("{:+.1f} %", percent.value);
  return std::isnan(percent.low) ? value : fmt::format("{} ({:+.1f} to {:+.1f})", value, percent.low, percent.high);
}

}  // namespace

page::PageTable interaction_table(const ExperimentFolder& folder, const ExperimentInteraction& of) {
  std::string measure = of.measure;
  for (const ExperimentMeasure& one : folder.measures)
    if (one.name == of.measure && of.by != "ratio") measure = one.with_unit();
  page::PageTable table{
      fmt::format("{} of {} and {}, {} from {} to {}: {}, paired by replication, {:g} % intervals. Those marked * stay "
                  "certain among all interactions, by Holm's method",
                  measure, of.lowers, of.more_than, of.axis, of.from, of.to,
                  of.by == "ratio" ? "changes as shares of the values before, and the ratio of their factors"
                                   : "changes as differences, and their difference",
                  100.0 * folder.confidence),
      of.others,
      {}};
  for (const std::string& head : {std::string("runs"), of.lowers, of.more_than, of.lowers + " against " + of.more_than})
    table.header.push_back(head);
  for (const InteractionPoint& point : of.points) {
    std::vector<std::string> row = point.settings;
    const experiments::results::Interval& interaction = point.interaction.difference;
    row.push_back(std::to_string(interaction.count));
    row.push_back(change_text(point.first));
    row.push_back(change_text(point.second));
    row.push_back(fmt::format("{} {}{}", change_text(point.interaction),
                              drawing::verdict(interaction.mean, interaction.half_width), point.stays ? "*" : ""));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ttf::report::experiment
