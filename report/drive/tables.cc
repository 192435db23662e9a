#include "report/drive/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/results/multiplicity.h"
#include "experiments/results/statistics.h"
#include "report/drawing/figures.h"
#include "report/drawing/tables.h"

namespace ttf::report::drive {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::measures::Measure;
using evaluation::measures::measures;

constexpr double kConfidence = 0.95;
constexpr std::size_t kMostRemarked = 6;  // more drives than these get remarks only on troubles

// The drives of every seed that all strategies share, strategy by strategy.
struct Repeated {
  std::vector<std::string> strategies;
  std::vector<std::vector<const Drive*>> drives;  // by seed, then strategy
};
std::map<std::string, Repeated> repeated(const std::vector<ReportedDrive>& drives) {
  std::map<std::string, std::map<std::uint64_t, std::map<std::string, const Drive*>>> by_scenario;
  std::map<std::string, Repeated> all;
  for (const ReportedDrive& reported : drives) {
    if (reported.drive->summary.is_null()) continue;
    by_scenario[reported.drive->scenario][reported.drive->seed].try_emplace(reported.drive->strategy, reported.drive);
    std::vector<std::string>& known = all[reported.drive->scenario].strategies;
    if (std::ranges::find(known, reported.drive->strategy) == known.end()) known.push_back(reported.drive->strategy);
  }
  for (auto& [scenario, one] : all)
    for (const auto& [seed, by_strategy] : by_scenario[scenario]) {
      if (by_strategy.size() != one.strategies.size()) continue;
      std::vector<const Drive*>& row = one.drives.emplace_back();
      for (const std::string& strategy : one.strategies) row.push_back(by_strategy.at(strategy));
    }
  std::erase_if(all, [](const auto& entry) { return entry.second.drives.size() < 2; });
  return all;
}

const Measure& position_error() { return evaluation::measures::measure_at("/rmse_truth/position_m"); }

bool is_on_page(const Measure& row) {
  return !row.path.empty() && !row.shown.label.empty() && row.shown.place != evaluation::measures::ShownIn::kTable;
}

// In the unit that people see.
experiments::results::Interval interval(const Repeated& repeated, const Measure& row, std::size_t strategy,
                                        std::optional<std::size_t> against) {
  experiments::results::Moments moments;
  for (const std::vector<const Drive*>& drives : repeated.drives) {
    const auto value = value_at(*drives[strategy], row.path);
    const auto other = against ? value_at(*drives[*against], row.path) : 0.0;
    if (value && other) moments.add((*value - *other) * row.shown.scale.factor);
  }
  return experiments::results::interval_of(moments, kConfidence);
}

// Returns the answer for a single draw: it has no interval, and ranks nothing.
std::string single_answer(const std::vector<ReportedDrive>& drives) {
  const bool one_folder = std::ranges::all_of(
      drives, [&](const ReportedDrive& reported) { return reported.drive->folder == drives.front().drive->folder; });
  std::string text;
  for (const ReportedDrive& reported : drives)
    if (const double error = position_rmse(reported); std::isfinite(error)) {
      const std::string& label = one_folder ? reported.drive->strategy : reported.drive->label;
      text += text.empty() ? fmt::format("{} is off by {} m in position", label, drawing::brief(error))
                           : fmt::format(", {} by {} m", label, drawing::brief(error));
    }
  if (text.empty()) return "No position was compared with the truth.";
  return fmt::format("In this one drive {} (root mean square against the truth, when the image is used).", text);
}

std::string repeated_answer(const std::string& scenario, const Repeated& repeated) {
  std::size_t best = 0;
  std::vector<double> means;
  for (std::size_t s = 0; s < repeated.strategies.size(); ++s) {
    means.push_back(interval(repeated, position_error(), s, std::nullopt).mean);
    if (!(means[best] <= means[s]) && std::isfinite(means[s])) best = s;  // the first may have no value
  }
  if (!std::isfinite(means[best]))
    return fmt::format("Over {} runs of {}: No position was compared with the truth.", repeated.drives.size(),
                       scenario);
  // All pairs are compared, since the best one is chosen among them.
  std::vector<experiments::results::Interval> pairs;
  std::vector<bool> of_best;
  for (std::size_t s = 0; s < repeated.strategies.size(); ++s)
    for (std::size_t other = s + 1; other < repeated.strategies.size(); ++other) {
      pairs.push_back(interval(repeated, position_error(), s, other));
      of_best.push_back(s == best || other == best);
    }
  const experiments::results::Family family = family_of(pairs, kConfidence);
  bool certain = family.comparisons > 0;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    certain = certain && (!of_best[p] || family.stays[p] || !std::isfinite(pairs[p].mean));
  const experiments::results::Interval least = interval(repeated, position_error(), best, std::nullopt);
  const std::string mean = drawing::with_interval(least.mean, least.half_width) + " m";
  std::string text =
      certain ? fmt::format("Over {} runs of {}, {} has the smallest position error, for certain: {} (95 %)",
                            repeated.drives.size(), scenario, repeated.strategies[best], mean)
              : fmt::format("{} runs of {} cannot tell which strategy has the smallest position error: {} {} (95 %)",
                            repeated.drives.size(), scenario, repeated.strategies[best], mean);
  for (std::size_t s = 0; s < repeated.strategies.size(); ++s) {
    if (s == best) continue;
    const experiments::results::Interval more = interval(repeated, position_error(), s, best);
    text += std::isfinite(more.mean) ? fmt::format("; {} {} m", repeated.strategies[s],
                                                   drawing::with_interval(more.mean, more.half_width, true))
                                     : fmt::format("; {} has no value", repeated.strategies[s]);
  }
  return text + ".";
}

// Adds the troubles of a drive.
void troubles_of(const ReportedDrive& reported, std::vector<std::string>& more) {
  const Drive& drive = *reported.drive;
  std::vector<std::string> troubles;
  for (const Measure& row : measures())
    if (const auto count = value_at(drive, row.path); !row.shown.trouble.empty() && count && *count > 0.0)
      troubles.push_back(counted(static_cast<std::uint64_t>(*count), std::string(row.shown.trouble)));
  if (!troubles.empty()) more.push_back(fmt::format("{}: {}.", drive.label, joined(troubles, " and ")));
  if (std::string beyond = beyond_words(drive.label, drive.stages); !beyond.empty()) more.push_back(std::move(beyond));
  if (const auto& faults = reported.series.faults; !faults.empty()) {
    std::uint64_t acts = 0;
    for (const auto& [index, fault] : faults) acts += fault.acts;
    more.push_back(fmt::format("{}: {} injected, which acted {} in all.", drive.label,
                               faults.size() == 1 ? "one fault was" : fmt::format("{} faults were", faults.size()),
                               counted(acts, "time")));
  }
}

// Returns a sentence that a sound drive deserves, too; empty if its summary has nothing of the kind.
std::string remark_on(const Drive& drive) {
  const auto at = [&](std::string_view pointer) { return value_at(drive, pointer); };
  std::string text;
  if (const auto mean = at("/age_when_used/mean_ms"), worst = at("/age_when_used/worst_ms"); mean && worst)
    text = fmt::format("a measurement is {:.1f} ms old on average when it is used, {:.1f} ms at worst", *mean, *worst);
  if (const auto nees = at("/nees/mean"), low = at("/nees/band_95/0"), high = at("/nees/band_95/1");
      nees && low && high && (*nees < *low || *nees > *high))
    text += fmt::format("{}its filter is {} than it believes: NEES {:.2f}, outside {:.2f}..{:.2f}",
                        text.empty() ? "" : "; ", *nees < *low ? "better" : "worse", *nees, *low, *high);
  return text.empty() ? "" : fmt::format("{}: {}.", drive.label, text);
}

// Returns whether a summary states that nothing went wrong.
bool is_sound(const ReportedDrive& reported) {
  return std::ranges::all_of(measures(), [&](const Measure& row) {
    return row.shown.trouble.empty() || value_at(*reported.drive, row.path) == 0.0;
  });
}

}  // namespace

std::optional<double> value_at(const Drive& drive, std::string_view pointer) {
  if (!drive.summary.is_object() || pointer.empty()) return std::nullopt;
  const Json::json_pointer at{std::string(pointer)};
  if (!drive.summary.contains(at) || !drive.summary.at(at).is_number()) return std::nullopt;
  return drive.summary.at(at).get<double>();
}

double position_rmse(const ReportedDrive& reported) {
  if (const auto error = value_at(*reported.drive, position_error().path)) return *error;
  if (!reported.drive->summary.is_null() || reported.series.position_error.empty()) return std::nan("");
  double squares = 0.0;
  for (const TimedValue& one : reported.series.position_error) squares += one.value * one.value;
  return std::sqrt(squares / static_cast<double>(reported.series.position_error.size()));
}

page::PageTable measure_table(const std::vector<ReportedDrive>& drives) {
  page::PageTable table{"", {"measure"}, {}};
  for (const ReportedDrive& reported : drives) table.header.push_back(reported.drive->label);
  for (const Measure& row : measures()) {
    if (!is_on_page(row)) continue;
    std::vector<std::string> cells{label_of(row)};
    bool any = false;
    for (const ReportedDrive& reported : drives) {
      const auto value = value_at(*reported.drive, row.path);
      cells.push_back(value ? drawing::cell(*value * row.shown.scale.factor, row.shown.decimals) : "-");
      any = any || (value && (*value != 0.0 || !row.shown.is_rare));
    }
    if (any) table.rows.push_back(std::move(cells));
  }
  return table;
}

std::vector<page::PageTable> repeated_tables(const std::vector<ReportedDrive>& drives) {
  std::vector<page::PageTable> tables;
  for (const auto& [scenario, one] : repeated(drives)) {
    page::PageTable table{fmt::format("{}: means of {} runs, 95 % intervals; differences are paired, run by run",
                                      scenario, one.drives.size()),
                          {"measure"},
                          {}};
    for (const std::string& strategy : one.strategies) table.header.push_back(strategy);
    for (std::size_t s = 1; s < one.strategies.size(); ++s)
      table.header.push_back(fmt::format("{} − {}", one.strategies[s], one.strategies[0]));
    for (const Measure& row : measures()) {
      if (!row.shown.has_interval) continue;
      std::vector<std::string> cells{label_of(row)};
      bool any = false;
      for (std::size_t s = 0; s < one.strategies.size(); ++s) {
        const experiments::results::Interval mean = interval(one, row, s, std::nullopt);
        cells.push_back(drawing::with_interval(mean.mean, mean.half_width));
        any = any || std::isfinite(mean.mean);
      }
      if (!any) continue;
      for (std::size_t s = 1; s < one.strategies.size(); ++s) {
        const experiments::results::Interval difference = interval(one, row, s, 0);
        cells.push_back(fmt::format("{} {}", drawing::with_interval(difference.mean, difference.half_width, true),
                                    drawing::verdict(difference.mean, difference.half_width)));
      }
      table.rows.push_back(std::move(cells));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

DrivesAnswer answer_of(const std::vector<ReportedDrive>& drives) {
  DrivesAnswer answer;
  const auto several = repeated(drives);
  std::map<std::string, std::vector<ReportedDrive>> by_scenario;
  for (const ReportedDrive& reported : drives) by_scenario[reported.drive->scenario].push_back(reported);
  bool single = false;
  for (const auto& [scenario, of_one] : by_scenario) {
    std::string& place = answer.answer.empty() ? answer.answer : answer.more.emplace_back();
    const auto found = several.find(scenario);
    if (found != several.end()) {
      place = repeated_answer(scenario, found->second);
    } else {
      place = (by_scenario.size() > 1 ? scenario + ": " : "") + single_answer(of_one);
      single = single || of_one.size() > 1;
    }
  }
  const std::size_t before = answer.more.size();
  for (const ReportedDrive& reported : drives) troubles_of(reported, answer.more);
  if (answer.more.size() == before && std::ranges::all_of(drives, is_sound))
    answer.more.push_back("Nothing went wrong: no list or object was missed, no deadline, and no slot had a problem.");
  if (single)
    answer.more.push_back(
        "One drive is one draw of the noise, so its differences are not certain: an interval takes "
        "several runs with other seeds in one report, or an experiment.");
  for (const ReportedDrive& reported : drives)
    if (std::string remark = remark_on(*reported.drive); drives.size() <= kMostRemarked && !remark.empty())
      answer.more.push_back(std::move(remark));
  return answer;
}

}  // namespace ttf::report::drive
