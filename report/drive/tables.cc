#include "report/drive/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/counted.h"
#include "experiments/results/multiplicity.h"
#include "experiments/results/statistics.h"
#include "report/drawing/figures.h"
#include "report/drawing/tables.h"

namespace ttf::report::drive {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kConfidence = 0.95;
constexpr std::size_t kMostRemarked = 6;  // more drives than these get remarks only on troubles

struct MeasureRow {
  const char* name;
  const char* pointer;
  int decimals;
  double factor = 1.0;
  bool rare = false;      // omitted if it is 0 in every drive
  bool repeated = false;  // has an interval over repeated drives
};

constexpr MeasureRow kMeasureRows[] = {
    {"position error against truth [m]", "/rmse_truth/position_m", 3, 1.0, false, true},
    {"velocity error against truth [m/s]", "/rmse_truth/velocity_mps", 3, 1.0, false, true},
    {"error of the visible face [m]", "/rmse_box/face_m", 3, 1.0, false, true},
    {"  of the gap to it [m]", "/rmse_box/gap_m", 3},
    {"  of the heading [rad]", "/rmse_box/heading_rad", 3},
    {"  of the speed [m/s]", "/rmse_box/speed_mps", 3},
    {"  of the acceleration [m/s^2]", "/rmse_box/acceleration_mps2", 3},
    {"  of the length [m]", "/rmse_box/length_m", 3},
    {"  of the width [m]", "/rmse_box/width_m", 3},
    {"position error against DGPS [m]", "/rmse_reference/position_m", 3, 1.0, false, true},
    {"velocity error against DGPS [m/s]", "/rmse_reference/velocity_mps", 3, 1.0, false, true},
    {"NEES (4 for a consistent filter)", "/nees/mean", 2, 1.0, false, true},
    {"  95 % band from", "/nees/band_95/0", 2},
    {"  to", "/nees/band_95/1", 2},
    {"  of the position, over its degrees", "/nees/per_degree/position", 2},
    {"  of the velocity", "/nees/per_degree/velocity", 2},
    {"  of the heading", "/nees/per_degree/heading", 2},
    {"  of the speed", "/nees/per_degree/speed", 2},
    {"  of the acceleration", "/nees/per_degree/acceleration", 2},
    {"  of the length", "/nees/per_degree/length", 2},
    {"  of the width", "/nees/per_degree/width", 2},
    {"NIS (1 for consistent predictions)", "/nis/per_degree", 2, 1.0, false, true},
    {"age when fused, mean [ms]", "/age_when_fused/mean_ms", 1, 1.0, false, true},
    {"  worst [ms]", "/age_when_fused/worst_ms", 1},
    {"age when used, mean [ms]", "/age_when_used/mean_ms", 1, 1.0, false, true},
    {"  worst [ms]", "/age_when_used/worst_ms", 1},
    {"observation lists received", "/observations/received", 0},
    {"  out of sequence", "/observations/out_of_sequence", 0},
    {"  fused late", "/observations/late", 0},
    {"  times held back", "/observations/held", 0},
    {"  lost", "/observations/lost", 0},
    {"uses of an image", "/uses", 0},
    {"  refused for its age", "/uses_refused_as_stale", 0, 1.0, true},
    {"  with a warning", "/uses_with_warning", 0},
    {"objects compared", "/objects/compared", 0},
    {"  missed", "/objects/missed", 0},
    {"  spurious", "/objects/spurious", 0},
    {"GOSPA [m]", "/gospa/distance_m", 3, 1.0, false, true},
    {"  its part from pairs [m^p]", "/gospa/localisation", 3},
    {"  from missed objects [m^p]", "/gospa/missed", 3},
    {"  from false ones [m^p]", "/gospa/false", 3},
    {"OSPA [m]", "/ospa/distance_m", 3},
    {"cut-off of both, c [m]", "/gospa/cut_off_m", 1},
    {"  their order, p", "/gospa/order", 1},
    {"MOTA [%]", "/clear_mot/mota", 1, 100.0, false, true},
    {"MOTP [m]", "/clear_mot/motp_m", 3},
    {"switches of track", "/clear_mot/switches", 0},
    {"objects mostly tracked", "/track_life/mostly_tracked", 0},
    {"  partly tracked", "/track_life/partly_tracked", 0},
    {"  mostly lost", "/track_life/mostly_lost", 0},
    {"life tracked, mean [%]", "/track_life/mean_fraction_tracked", 1, 100.0},
    {"tracks broken and resumed", "/track_life/fragmentations", 0},
    {"precision of the time base [us]", "/precision_us", 3},
    {"slot problems", "/slot_problems", 0},
    {"deadlines missed", "/deadlines_missed", 0},
    {"times that odometry stopped", "/odometry/stops", 0, 1.0, true},
    {"fragments refused", "/refused_fragments", 0, 1.0, true},
    {"CAN frames refused", "/refused_can_frames", 0, 1.0, true},
    {"FlexRay load per channel [%]", "/flexray_load", 1, 100.0},
};
// Counts that are 0 in a sound drive.
constexpr std::pair<const char*, const char*> kTroubles[] = {{"/deadlines_missed", "missed deadline"},
                                                             {"/observations/lost", "lost observation list"},
                                                             {"/slot_problems", "slot problem"},
                                                             {"/objects/missed", "missed object"}};

// The drives of every seed that all strategies share, strategy by strategy.
struct Repeated {
  std::vector<std::string> strategies;
  std::vector<std::vector<const Drive*>> drives;  // by seed, then strategy
};
std::map<std::string, Repeated> repeated(const std::vector<ToldDrive>& drives) {
  std::map<std::string, std::map<std::uint64_t, std::map<std::string, const Drive*>>> by_scenario;
  std::map<std::string, Repeated> all;
  for (const ToldDrive& told : drives) {
    if (told.drive->summary.is_null()) continue;
    by_scenario[told.drive->scenario][told.drive->seed].try_emplace(told.drive->strategy, told.drive);
    std::vector<std::string>& known = all[told.drive->scenario].strategies;
    if (std::ranges::find(known, told.drive->strategy) == known.end()) known.push_back(told.drive->strategy);
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

experiments::results::Interval interval(const Repeated& repeated, const char* pointer, std::size_t strategy,
                                        std::optional<std::size_t> against) {
  experiments::results::Moments moments;
  for (const std::vector<const Drive*>& row : repeated.drives) {
    const auto value = measure_at(*row[strategy], pointer);
    const auto other = against ? measure_at(*row[*against], pointer) : 0.0;
    if (value && other) moments.add(*value - *other);
  }
  return experiments::results::interval_of(moments, kConfidence);
}

// Returns the answer for a single draw: it has no interval, and ranks nothing.
std::string single_answer(const std::vector<ToldDrive>& drives) {
  const bool one_folder = std::ranges::all_of(
      drives, [&](const ToldDrive& told) { return told.drive->folder == drives.front().drive->folder; });
  std::string text;
  for (const ToldDrive& told : drives)
    if (const double error = position_rmse(told); std::isfinite(error)) {
      const std::string& label = one_folder ? told.drive->strategy : told.drive->label;
      text += text.empty() ? fmt::format("{} is off by {} m in position", label, drawing::brief(error))
                           : fmt::format(", {} by {} m", label, drawing::brief(error));
    }
  if (text.empty()) return "No position was compared with the truth.";
  return fmt::format("In this one drive {} (root mean square against the truth, when the image is used).", text);
}

std::string repeated_answer(const std::string& scenario, const Repeated& repeated) {
  const char* const pointer = kMeasureRows[0].pointer;
  std::size_t best = 0;
  std::vector<double> means;
  for (std::size_t s = 0; s < repeated.strategies.size(); ++s) {
    means.push_back(interval(repeated, pointer, s, std::nullopt).mean);
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
      pairs.push_back(interval(repeated, pointer, s, other));
      of_best.push_back(s == best || other == best);
    }
  const experiments::results::Family family = family_of(pairs, kConfidence);
  bool certain = family.comparisons > 0;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    certain = certain && (!of_best[p] || family.stays[p] || !std::isfinite(pairs[p].mean));
  const experiments::results::Interval least = interval(repeated, pointer, best, std::nullopt);
  const std::string mean = drawing::with_interval(least.mean, least.half_width) + " m";
  std::string text =
      certain ? fmt::format("Over {} runs of {}, {} has the smallest position error, for certain: {} (95 %)",
                            repeated.drives.size(), scenario, repeated.strategies[best], mean)
              : fmt::format("{} runs of {} cannot tell which strategy has the smallest position error: {} {} (95 %)",
                            repeated.drives.size(), scenario, repeated.strategies[best], mean);
  for (std::size_t s = 0; s < repeated.strategies.size(); ++s) {
    if (s == best) continue;
    const experiments::results::Interval more = interval(repeated, pointer, s, best);
    text += std::isfinite(more.mean) ? fmt::format("; {} {} m", repeated.strategies[s],
                                                   drawing::with_interval(more.mean, more.half_width, true))
                                     : fmt::format("; {} has no value", repeated.strategies[s]);
  }
  return text + ".";
}

// Returns 0 without a count.
std::uint64_t count_at(const Drive& drive, const char* pointer) {
  if (!drive.summary.is_object()) return 0;
  const Json::json_pointer at(pointer);
  if (!drive.summary.contains(at) || !drive.summary.at(at).is_number_unsigned()) return 0;
  return drive.summary.at(at).get<std::uint64_t>();
}

// Adds the troubles of a drive.
void troubles_of(const ToldDrive& told, std::vector<std::string>& more) {
  const Drive& drive = *told.drive;
  std::vector<std::string> troubles;
  for (const auto& [pointer, what] : kTroubles)
    if (const std::uint64_t count = count_at(drive, pointer); count > 0) troubles.push_back(counted(count, what));
  if (!troubles.empty()) more.push_back(fmt::format("{}: {}.", drive.label, joined(troubles, " and ")));
  if (std::string beyond = beyond_words(drive.label, drive.stages); !beyond.empty()) more.push_back(std::move(beyond));
  if (const auto& faults = told.series.faults; !faults.empty()) {
    std::uint64_t acts = 0;
    for (const auto& [index, fault] : faults) acts += fault.acts;
    more.push_back(fmt::format("{}: {} injected, which acted {} in all.", drive.label,
                               faults.size() == 1 ? "one fault was" : fmt::format("{} faults were", faults.size()),
                               counted(acts, "time")));
  }
}

// Returns a sentence that a sound drive deserves, too; empty if its summary has nothing of the kind.
std::string remark_on(const Drive& drive) {
  const auto at = [&](const char* pointer) { return measure_at(drive, pointer); };
  std::string text;
  if (const auto mean = at("/age_when_used/mean_ms"), worst = at("/age_when_used/worst_ms"); mean && worst)
    text = fmt::format("a measurement is {:.1f} ms old on average when it is used, {:.1f} ms at worst", *mean, *worst);
  if (const auto nees = at("/nees/mean"), low = at("/nees/band_95/0"), high = at("/nees/band_95/1");
      nees && low && high && (*nees < *low || *nees > *high))
    text += fmt::format("{}its filter is {} than it believes: NEES {:.2f}, outside {:.2f}..{:.2f}",
                        text.empty() ? "" : "; ", *nees < *low ? "better" : "worse", *nees, *low, *high);
  return text.empty() ? "" : fmt::format("{}: {}.", drive.label, text);
}

// Returns whether a summary tells that nothing went wrong.
bool is_sound(const ToldDrive& told) {
  return std::ranges::all_of(kTroubles, [&](const auto& trouble) {
    const auto count = measure_at(*told.drive, trouble.first);
    return count && *count == 0.0;
  });
}

}  // namespace

std::optional<double> measure_at(const Drive& drive, const char* pointer) {
  if (!drive.summary.is_object()) return std::nullopt;
  const Json::json_pointer at(pointer);
  if (!drive.summary.contains(at) || !drive.summary.at(at).is_number()) return std::nullopt;
  return drive.summary.at(at).get<double>();
}

double position_rmse(const ToldDrive& told) {
  if (const auto error = measure_at(*told.drive, kMeasureRows[0].pointer)) return *error;
  if (!told.drive->summary.is_null() || told.series.position_error.empty()) return std::nan("");
  double squares = 0.0;
  for (const TimedValue& one : told.series.position_error) squares += one.value * one.value;
  return std::sqrt(squares / static_cast<double>(told.series.position_error.size()));
}

page::PageTable measure_table(const std::vector<ToldDrive>& drives) {
  page::PageTable table{"", {"measure"}, {}};
  for (const ToldDrive& told : drives) table.header.push_back(told.drive->label);
  for (const MeasureRow& row : kMeasureRows) {
    std::vector<std::string> cells{row.name};
    bool any = false;
    for (const ToldDrive& told : drives) {
      const auto value = measure_at(*told.drive, row.pointer);
      cells.push_back(value ? drawing::cell(*value * row.factor, row.decimals) : "-");
      any = any || (value && (*value != 0.0 || !row.rare));
    }
    if (any) table.rows.push_back(std::move(cells));
  }
  return table;
}

std::vector<page::PageTable> repeated_tables(const std::vector<ToldDrive>& drives) {
  std::vector<page::PageTable> tables;
  for (const auto& [scenario, one] : repeated(drives)) {
    page::PageTable table{fmt::format("{}: means of {} runs, 95 % intervals; differences are paired, run by run",
                                      scenario, one.drives.size()),
                          {"measure"},
                          {}};
    for (const std::string& strategy : one.strategies) table.header.push_back(strategy);
    for (std::size_t s = 1; s < one.strategies.size(); ++s)
      table.header.push_back(fmt::format("{} − {}", one.strategies[s], one.strategies[0]));
    for (const MeasureRow& row : kMeasureRows) {
      if (!row.repeated) continue;
      std::vector<std::string> cells{row.name};
      bool any = false;
      for (std::size_t s = 0; s < one.strategies.size(); ++s) {
        const experiments::results::Interval mean = interval(one, row.pointer, s, std::nullopt);
        cells.push_back(drawing::with_interval(mean.mean, mean.half_width));
        any = any || std::isfinite(mean.mean);
      }
      if (!any) continue;
      for (std::size_t s = 1; s < one.strategies.size(); ++s) {
        const experiments::results::Interval difference = interval(one, row.pointer, s, 0);
        cells.push_back(fmt::format("{} {}", drawing::with_interval(difference.mean, difference.half_width, true),
                                    drawing::verdict(difference.mean, difference.half_width)));
      }
      table.rows.push_back(std::move(cells));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

DrivesAnswer answer_of(const std::vector<ToldDrive>& drives) {
  DrivesAnswer answer;
  const auto several = repeated(drives);
  std::map<std::string, std::vector<ToldDrive>> by_scenario;
  for (const ToldDrive& told : drives) by_scenario[told.drive->scenario].push_back(told);
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
  for (const ToldDrive& told : drives) troubles_of(told, answer.more);
  if (answer.more.size() == before && std::ranges::all_of(drives, is_sound))
    answer.more.push_back("Nothing went wrong: no list or object was missed, no deadline, and no slot had a problem.");
  if (single)
    answer.more.push_back(
        "One drive is one draw of the noise, so its differences are not certain: an interval takes "
        "several runs with other seeds in one report, or an experiment.");
  for (const ToldDrive& told : drives)
    if (std::string remark = remark_on(*told.drive); drives.size() <= kMostRemarked && !remark.empty())
      answer.more.push_back(std::move(remark));
  return answer;
}

}  // namespace ttf::report::drive
