#include "report/experiment/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/counted.h"
#include "experiments/results/multiplicity.h"
#include "experiments/results/pairs.h"
#include "experiments/results/percent.h"
#include "experiments/results/ratio.h"
#include "report/drawing/figures.h"
#include "report/experiment/interactions.h"
#include "report/experiment/plots.h"
#include "report/page/page.h"

namespace ttf::report::experiment {
namespace {

using experiments::results::Pairs;

constexpr std::size_t kMostFailures = 50;

// Returns the values of two paradigms at a point, replication by replication.
std::vector<std::pair<double, double>> both_values(const std::vector<experiments::results::Row>& rows,
                                                   std::size_t column, std::size_t paradigm, std::size_t against) {
  std::map<std::uint32_t, std::pair<std::optional<double>, std::optional<double>>> by_replication;
  for (const experiments::results::Row& row : rows) {
    if (row.status != experiments::results::kDone || !std::isfinite(row.values[column])) continue;
    if (row.key.paradigm == paradigm) by_replication[row.key.replication].first = row.values[column];
    if (row.key.paradigm == against) by_replication[row.key.replication].second = row.values[column];
  }
  std::vector<std::pair<double, double>> values;
  for (const auto& [replication, both] : by_replication)
    if (both.first && both.second) values.emplace_back(*both.first, *both.second);
  return values;
}

// The measure's place in the rows; there are drives.
std::size_t column_of(const ExperimentFolder& folder, std::size_t m) {
  const auto& columns = folder.store->head().measures;
  return static_cast<std::size_t>(std::ranges::find(columns, folder.measures[m].name) - columns.begin());
}

// Returns the first measure's paired difference of two paradigms at a point, from the drives themselves.
experiments::results::Interval paired(const std::vector<experiments::results::Row>& rows, std::size_t column,
                                      std::size_t paradigm, std::size_t against, double confidence) {
  experiments::results::Moments moments;
  for (const auto& [one, other] : both_values(rows, column, paradigm, against)) moments.add(one - other);
  return interval_of(moments, confidence);
}

// The first measure's comparisons of all pairs of paradigms at all points, as one family. Empty without drives.
Pairs all_pairs(const ExperimentFolder& folder) {
  if (!folder.store) return {};
  const std::size_t column = column_of(folder, 0);
  std::vector<experiments::results::PairedDifference> pairs;
  for (std::size_t point = 0; point < folder.points.size(); ++point) {
    const std::vector<experiments::results::Row> rows = folder.store->of_point(folder.points[point].point);
    for (std::size_t p = 0; p < folder.paradigms.size(); ++p)
      for (std::size_t other = p + 1; other < folder.paradigms.size(); ++other)
        pairs.push_back({point, p, other, paired(rows, column, p, other, folder.confidence), false});
  }
  return experiments::results::judged_together(std::move(pairs), folder.confidence);
}

// Counts the points at which each paradigm has less than all others, for certain.
std::vector<std::size_t> least_for_certain(const ExperimentFolder& folder, const Pairs& pairs) {
  const std::size_t paradigms = folder.paradigms.size();
  std::vector<std::size_t> least(paradigms);
  for (std::size_t pair = 0; pair < pairs.all.size();) {
    std::vector<std::size_t> wins(paradigms);
    for (std::size_t p = 0; p < paradigms; ++p)
      for (std::size_t other = p + 1; other < paradigms; ++other, ++pair)
        if (pairs.all[pair].stays) ++wins[pairs.all[pair].difference.mean < 0.0 ? p : other];
    for (std::size_t p = 0; p < paradigms; ++p) least[p] += wins[p] + 1 == paradigms;
  }
  return least;
}

std::string family_words(const experiments::results::Family& family, double confidence) {
  return fmt::format("{} of {}, by Holm's method. Any verdict among them is false with a probability of at most {:g} %",
                     family.certain, counted(family.comparisons, "comparison"),
                     std::round(1e6 * (1.0 - confidence)) * 1e-4);
}

// The first cells of a row: the axes' names, or their values at a point.
std::vector<std::string> axes_of(const ExperimentFolder& folder) {
  return folder.axes.empty() ? std::vector<std::string>{"point"} : folder.axes;
}
std::vector<std::string> settings_of(const ExperimentPoint& point) {
  return point.settings.empty() ? std::vector<std::string>{std::to_string(point.point)} : point.settings;
}

// Names all pairs of paradigms that stay certain together, or "".
std::string certain_pairs(const ExperimentFolder& folder, const Pairs& pairs) {
  std::vector<std::string> points;
  for (const ExperimentPoint& point : folder.points) {
    const std::vector<std::string> axes = axes_of(folder), settings = settings_of(point);
    std::vector<std::string> parts;
    for (std::size_t a = 0; a < axes.size(); ++a) parts.push_back(axes[a] + " " + settings[a]);
    points.push_back(joined(parts));
  }
  return experiments::results::certain_pairs(pairs, folder.paradigms, points);
}

page::PageTable means_table(const ExperimentFolder& folder, std::size_t m) {
  const ExperimentMeasure& measure = folder.measures[m];
  page::PageTable table{fmt::format("{}{}; mean of the replications, {:g} % intervals", measure.with_unit(),
                                    measure.meaning.empty() ? "" : ": " + measure.meaning, 100.0 * folder.confidence),
                        axes_of(folder),
                        {}};
  table.header.push_back("runs");
  for (const std::string& paradigm : folder.paradigms) table.header.push_back(paradigm);
  for (const ExperimentPoint& point : folder.points) {
    std::vector<std::string> row = settings_of(point);
    std::uint64_t drives = 0;
    for (const auto& estimates : point.estimates) drives = std::max(drives, estimates[m].mean.count);
    row.push_back(std::to_string(drives));
    for (const auto& estimates : point.estimates) row.push_back(interval_words(estimates[m].mean, false, drives));
    table.rows.push_back(std::move(row));
  }
  return table;
}

bool is_baseline(const ExperimentFolder& folder, const std::string& paradigm) {
  return folder.compared_axis.empty() && paradigm == folder.baseline;
}
// Returns whether there are differences: one paradigm alone is compared along an axis only.
bool compares(const ExperimentFolder& folder) { return folder.paradigms.size() > 1 || !folder.compared_axis.empty(); }

// Whether a table has the differences in per cent, too: that of the measure in question, if the drives are there.
bool has_percent(const ExperimentFolder& folder, std::size_t m) {
  return m == 0 && folder.store && folder.compared_axis.empty();
}
std::string percent_cell(const std::vector<std::pair<double, double>>& values, double confidence) {
  const experiments::results::Ratio ratio = experiments::results::ratio_of(values, confidence);
  const auto percent = [](double factor) { return 100.0 * (factor - 1.0); };
  return experiments::results::percent_words(percent(ratio.value), percent(ratio.low), percent(ratio.high), true);
}

page::PageTable differences_table(const ExperimentFolder& folder, std::size_t m) {
  std::vector<experiments::results::Interval> differences;
  for (const ExperimentPoint& point : folder.points)
    for (const auto& estimates : point.estimates)
      differences.push_back(estimates[m].difference.value_or(experiments::results::Interval{}));
  const experiments::results::Family family = family_of(differences, folder.confidence);
  page::PageTable table{
      fmt::format(
          "{} minus that of {}, paired by replication, and whether it is less or more by its own interval. Those "
          "marked * stay certain together: {}",
          folder.measures[m].with_unit(), folder.baseline_name(), family_words(family, folder.confidence)),
      axes_of(folder),
      {}};
  for (const std::string& paradigm : folder.paradigms)
    if (!is_baseline(folder, paradigm)) {
      table.header.push_back(fmt::format("{} − {}", paradigm, folder.baseline_name()));
      if (has_percent(folder, m)) table.header.emplace_back("in per cent");
    }
  auto stays = family.stays.begin();
  std::vector<experiments::results::Row> rows;
  const std::size_t column = has_percent(folder, m) ? column_of(folder, m) : 0;
  const auto baseline =
      static_cast<std::size_t>(std::ranges::find(folder.paradigms, folder.baseline) - folder.paradigms.begin());
  for (const ExperimentPoint& point : folder.points) {
    std::vector<std::string> row = settings_of(point);
    if (has_percent(folder, m)) rows = folder.store->of_point(point.point);
    for (std::size_t p = 0; p < folder.paradigms.size(); ++p, ++stays) {
      if (is_baseline(folder, folder.paradigms[p])) continue;
      const auto& difference = point.estimates[p][m].difference;
      row.push_back(difference
                        ? fmt::format("{} {}{}", interval_words(*difference, true),
                                      drawing::verdict(difference->mean, difference->half_width), *stays ? "*" : "")
                        : "-");
      if (has_percent(folder, m))
        row.push_back(percent_cell(both_values(rows, column, p, baseline), folder.confidence));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string expectation_sentence(const ExperimentExpectation& one) {
  std::string text = fmt::format("Expected: {}. ", one.expected);
  if (one.outcome == experiments::results::Outcome::kUndecided)
    text += "The drives cannot tell";
  else
    text += one.holds ? "It holds" : !one.outcome ? "It does not hold for certain" : "It does not hold";
  for (std::size_t p = 0; p < one.where_not.size() && !one.holds; ++p) {
    text += fmt::format("{}{}", p == 0 ? " at " : "; ", one.where_not[p]);
    if (p < one.why_not.size()) text += fmt::format(" ({})", one.why_not[p]);
  }
  return text + ".";
}

// The first measure of a paradigm at the first point.
std::string mean_text(const ExperimentFolder& folder, std::size_t paradigm) {
  const experiments::results::Interval& mean = folder.points[0].estimates[paradigm][0].mean;
  return interval_words(mean) + (folder.measures[0].unit.empty() ? "" : " " + folder.measures[0].unit);
}

// Names the paradigms that have the least first measure for certain, with the number of points of each. A paradigm has it
// at a point if its paired differences from all others stay certain among all pairs at all points, by Holm's method. The
// drives in the store decide; without a store, and where the drives cannot decide, the sentence says so.
std::string smallest(const ExperimentFolder& folder, const Pairs& pairs) {
  const std::string& measure = folder.measures[0].name;
  const auto has_value = [](const ExperimentPoint& point) {
    return std::ranges::any_of(point.estimates, [](const auto& one) { return std::isfinite(one[0].mean.mean); });
  };
  if (std::ranges::none_of(folder.points, has_value)) return fmt::format("No paradigm has a value of {}.", measure);
  if (folder.paradigms.size() == 1)
    return fmt::format("There is no other paradigm to compare {} of {} with{}.", measure, folder.paradigms[0],
                       folder.points.size() == 1 ? "; it is " + mean_text(folder, 0) : "");
  if (!folder.store)
    return fmt::format("Without results.sqlite it is unknown which paradigm has the smallest {}.", measure);
  const std::vector<std::size_t> least = least_for_certain(folder, pairs);
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < least.size(); ++p)
    if (least[p] > 0) order.push_back(p);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t p) { return least[p]; });
  if (order.empty()) return fmt::format("The drives cannot tell which paradigm has the smallest {}.", measure);
  const std::size_t points = folder.points.size();
  if (points == 1)
    return fmt::format("{} has the smallest {}, for certain: {}.", folder.paradigms[order[0]], measure,
                       mean_text(folder, order[0]));
  std::string text;
  std::size_t decided = 0;
  for (const std::size_t p : order) {
    text += text.empty() ? fmt::format("For certain {} has the smallest {}", folder.paradigms[p], measure)
                         : "; " + folder.paradigms[p];
    text += least[p] == points ? fmt::format(" at all {} points", points)
                               : fmt::format(" at {} of {} points", least[p], points);
    decided += least[p];
  }
  return text + (decided == points ? "." : fmt::format("; at {} the drives cannot tell.", points - decided));
}

// `lead` has been said already.
std::vector<std::string> sentences(const ExperimentFolder& folder, const Pairs& pairs, const std::string& lead) {
  std::vector<std::string> all;
  if (folder.asks_more() && folder.paradigms.size() > 1) all.push_back(smallest(folder, pairs));
  if (pairs.family.comparisons > 0) {
    const std::string names = certain_pairs(folder, pairs);
    all.push_back(fmt::format("All pairs of paradigms at all points were compared. Certain are {}.{}{}{}",
                              family_words(pairs.family, folder.confidence), names.empty() ? "" : " These are: ", names,
                              names.empty() ? "" : "."));
  }
  for (std::size_t at = 0; at < folder.answer.size();) {
    const std::size_t end = std::min(folder.answer.find('\n', at), folder.answer.size());
    if (end > at && folder.answer.substr(at, end - at) != lead) all.push_back(folder.answer.substr(at, end - at));
    at = end + 1;
  }
  bool certain = false;
  for (const ExperimentCrossing& crossing : folder.crossings) {
    certain = certain || crossing.certain;
    if (!crossing.certain)
      all.push_back(fmt::format("{} and {} may cross at {} {}{}, but not for certain.", crossing.paradigm,
                                folder.baseline, crossing.axis, drawing::brief(crossing.at),
                                crossing.others.empty() ? "" : ", with " + crossing.others));
  }
  if (!certain && !folder.axes.empty() && folder.paradigms.size() > 1 && folder.compared_axis.empty())
    all.push_back("No paradigm crosses " + folder.baseline + " for certain along an axis.");
  for (const ExperimentExpectation& one : folder.expectations) all.push_back(expectation_sentence(one));
  if (folder.failed > 0) all.push_back(counted(folder.failed, "run") + " failed; they are below.");
  return all;
}

std::string_view steps_option(const ExperimentFolder& folder) {
  return folder.libraries.empty() ? "" : " --steps FOLDER";
}

void failures(page::Page& page, const ExperimentFolder& folder) {
  if (!folder.store || folder.failed == 0) return;
  page::PageTable table{
      fmt::format("`ttfusion experiment FILE{} --replay` with the first column drives one of them again",
                  steps_option(folder)),
      {"point/paradigm/replication", "error"},
      {}};
  std::uint64_t more = 0;
  folder.store->for_each([&](const experiments::results::Row& row) {
    if (row.status == experiments::results::kDone) return;
    if (table.rows.size() >= kMostFailures) {
      ++more;
      return;
    }
    const std::string paradigm = row.key.paradigm < folder.paradigms.size() ? folder.paradigms[row.key.paradigm]
                                                                            : std::to_string(row.key.paradigm);
    table.rows.push_back({fmt::format("{}/{}/{}", row.key.point, paradigm, row.key.replication), row.status});
  });
  page.section("Failed runs");
  page.table(table);
  if (more > 0) page.paragraph(fmt::format("And {} more, in runs.csv.", more));
}

void how_made(page::Page& page, const ExperimentFolder& folder) {
  page.section("How to repeat it");
  const std::string file = page::shell_word(folder.file.empty() ? "experiments/" + folder.name + ".yaml" : folder.file);
  if (!folder.store) {
    page.paragraph("There is no results.sqlite: the inputs of the runs are unknown.");
    return;
  }
  const experiments::results::StoreHead& head = folder.store->head();
  std::vector<std::pair<std::string, std::string>> facts{
      {"version", head.version},
      {"identity of all inputs", head.identity},
      {"seed", std::to_string(folder.seed)},
      {"rows in results.sqlite", std::to_string(folder.store->count())}};
  if (!folder.libraries.empty()) facts.emplace_back("libraries of steps", joined(folder.libraries));
  page.facts(facts);
  page.paragraph(
      std::string("These commands repeat the experiment, and one run with its log and a report. The experiment's "
                  "file is below") +
      (folder.file.empty() ? "; it may be in another folder than experiments/:" : ":"));
  page.command(
      fmt::format("ttfusion experiment {0}{2} --out again\nttfusion experiment {0} --replay {1}{2} --out one\n"
                  "ttfusion report one -o one.html\n",
                  file, page::shell_word(fmt::format("0/{}/0", folder.paradigms.front())), steps_option(folder)));
  page.preformatted("The experiment's file", head.text);
}

// Adds the sections of a run's page for one drive of each paradigm.
void one_of_each(page::Page& page, const ExperimentFolder& folder, const ExperimentDrives& drives,
                 const drive::DiagramWindow& window) {
  if (drives.drives.empty() && drives.why_none.empty()) return;
  page.section("One drive of each paradigm");
  if (drives.drives.empty()) {
    page.paragraph(drives.why_none);
    return;
  }
  const auto point = std::ranges::find(folder.points, drives.point, &ExperimentPoint::point);
  std::vector<std::string> settings;
  for (std::size_t a = 0; point != folder.points.end() && a < folder.axes.size(); ++a)
    settings.push_back(folder.axes[a] + " " + point->settings[a]);
  page.paragraph(fmt::format(
      "The runs of point {}{}, replication {}, driven again for their logs, with the very numbers in "
      "results.sqlite. All paradigms had the same draws. One replication of many makes no difference certain.",
      drives.point, settings.empty() ? "" : " (" + joined(settings) + ")", drives.replication));
  std::vector<const drive::Drive*> shown;
  for (const drive::Drive& drive : drives.drives) shown.push_back(&drive);
  const std::vector<drive::ReportedDrive> all = drive::reported_drives(shown);
  scene_section(page, all);
  errors_section(page, all);
  stages_section(page, all);
  timing_section(page, all, window);
  time_base_section(page, all, window.most);
  troubles_section(page, all);
}

// The first line of the answer where it asks more than which paradigm has least.
std::string answer_by(const ExperimentFolder& folder, const Pairs& pairs) {
  const std::string first = folder.answer.substr(0, folder.answer.find('\n'));
  return folder.asks_more() && !first.empty() ? first : smallest(folder, pairs);
}

}  // namespace

std::string experiment_report_html(const ExperimentFolder& folder, const ExperimentDrives& drives,
                                   const drive::DiagramWindow& window) {
  page::Page page(folder.name, "Report of an experiment");
  page.section("Question");
  page.lead(folder.question);
  std::vector<std::string> axes;
  for (std::size_t a = 0; a < folder.axes.size(); ++a)
    axes.push_back(fmt::format("{} ({} to {})", folder.axes[a], folder.points.front().settings[a],
                               folder.points.back().settings[a]));
  page.facts({{"paradigms", joined(folder.paradigms)},
              {"baseline", folder.baseline_name()},
              {"axes", axes.empty() ? "none" : joined(axes)},
              {"points", std::to_string(folder.points.size())},
              {"runs", fmt::format("{}, of which {} failed", folder.drives, folder.failed)},
              {"measure in question", folder.measures[0].with_unit()}});
  page.section("Answer");
  const Pairs pairs = all_pairs(folder);
  const std::string lead = answer_by(folder, pairs);
  page.lead(lead);
  page.points(sentences(folder, pairs, lead));
  page.table(means_table(folder, 0));
  for (const ExperimentInteraction& one : folder.interactions) page.table(interaction_table(folder, one));
  if (compares(folder)) page.table(differences_table(folder, 0));
  page.section("Over the axes");
  page.plot(means_plot(folder));
  page.plot(differences_plot(folder));
  if (folder.store) {
    page.section("Run by run");
    page.plot(replications_plot(folder));
  }
  page.section("All measures");
  for (std::size_t m = 1; m < folder.measures.size(); ++m) {
    page.open_details(folder.measures[m].with_unit());
    page.table(means_table(folder, m));
    if (compares(folder)) page.table(differences_table(folder, m));
    page.close_details();
  }
  one_of_each(page, folder, drives, window);
  failures(page, folder);
  how_made(page, folder);
  return page.html();
}

}  // namespace ttf::report::experiment
