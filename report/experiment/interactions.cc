#include "report/experiment/interactions.h"

#include <fmt/format.h>

#include <cmath>

#include "core/counted.h"
#include "experiments/results/percent.h"
#include "report/drawing/figures.h"

namespace ttf::report::experiment {
namespace {

std::string change_text(const ExperimentChange& change) {
  if (!change.percent) return drawing::with_interval(change.difference.mean, change.difference.half_width, true);
  const experiments::results::Ratio& percent = *change.percent;
  return experiments::results::percent_words(percent.value, percent.low, percent.high, true);
}

// "1 of 3 interactions": of all of the experiment, which are one family.
std::string interactions_text(const ExperimentFolder& folder) {
  std::size_t interactions = 0, certain = 0;
  for (const ExperimentInteraction& one : folder.interactions)
    for (const InteractionPoint& point : one.points) {
      interactions += std::isfinite(point.interaction.difference.half_width);
      certain += point.stays;
    }
  return fmt::format("{} of {}", certain, counted(interactions, "interaction"));
}

}  // namespace

page::PageTable interaction_table(const ExperimentFolder& folder, const ExperimentInteraction& of, Marks marks) {
  std::string measure = of.measure;
  for (const ExperimentMeasure& one : folder.measures)
    if (one.name == of.measure && of.by != "ratio") measure = one.with_unit();
  page::PageTable table{
      fmt::format("{} of {} and {}, {} from {} to {}: {}, paired by replication, {:g} % intervals. {}, {}, stay "
                  "certain together by Holm's method at {:g} %",
                  measure, of.lowers, of.more_than, of.axis, of.from, of.to,
                  experiments::results::interaction_columns(of.by == "ratio"), 100.0 * folder.confidence,
                  interactions_text(folder), marks == Marks::kBold ? "in bold" : "marked *",
                  std::round(1e6 * (1.0 - folder.confidence)) * 1e-4),
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
    const std::string words = fmt::format("{} {}", change_text(point.interaction),
                                          drawing::verdict(interaction.mean, interaction.half_width));
    row.push_back(!point.stays ? words : marks == Marks::kBold ? "**" + words + "**" : words + "*");
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ttf::report::experiment
