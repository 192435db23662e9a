#include "experiments/sweep/answers/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/results/equivalence.h"
#include "experiments/results/multiplicity.h"
#include "experiments/results/ratio.h"
#include "experiments/results/store.h"
#include "experiments/sweep/answers/figures.h"
#include "experiments/sweep/answers/point_drives.h"

namespace ttf::experiments::sweep::answers {
namespace {

using evaluation::measures::find_measure;
using results::Interval;
using results::Moments;
using results::Quadruple;
using results::Row;

std::size_t index_of(const SweepFile& sweep, const std::string& paradigm) {
  const auto found = std::find_if(sweep.paradigms.begin(), sweep.paradigms.end(),
                                  [&](const Paradigm& one) { return one.name == paradigm; });
  return static_cast<std::size_t>(found - sweep.paradigms.begin());
}

std::size_t measure_index(const SweepFile& sweep, std::string_view name) {
  const auto found = std::find(sweep.measures.begin(), sweep.measures.end(), name);
  return static_cast<std::size_t>(found - sweep.measures.begin());
}

// The outcome at one point, with the reason unless the expectation holds.
struct Verdict {
  Outcome outcome = Outcome::kHolds;
  std::string why = {};
};

std::string with_unit(const std::string& text, const Expectation& expectation) {
  const std::string_view unit = find_measure(expectation.measure)->unit;
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

Verdict undecided(const std::string& why) { return {Outcome::kUndecided, "cannot tell: " + why}; }

// Compares the two measures drive by drive.
Verdict agree(const SweepFile& sweep, const Expectation& expectation, const PointDrives& drives) {
  const std::size_t one = measure_index(sweep, expectation.measure), other = measure_index(sweep, expectation.agrees);
  results::EquivalenceTest test(expectation.margin);
  for (const Row* row : drives.of(index_of(sweep, expectation.less)))
    test.add(drives.value(*row, one), drives.value(*row, other));
  const results::Agreement agreement = test.agreement(sweep.confidence);
  if (agreement == results::Agreement::kWithin) return {};
  const Interval difference = interval_of(test.difference(), sweep.confidence);
  if (difference.count < 2)
    return undecided(fmt::format("{} with both measures; more replications", counted(difference.count, "drive")));
  const std::string interval = interval_text(difference, true);
  const std::string margin = with_unit(fmt::format("{:.2g}", test.margin()), expectation);
  if (agreement == results::Agreement::kBeyond)
    return {Outcome::kFails, fmt::format("differs by {}, beyond the margin of {}", interval, margin)};
  const bool wide = difference.half_width > test.margin();
  return undecided(fmt::format("the interval {} is {} the margin of {}; more replications", interval,
                               wide ? "wider than" : "on both sides of", margin));
}

Verdict less(const SweepFile& sweep, const Expectation& expectation, const PointDrives& drives) {
  const std::size_t m = measure_index(sweep, expectation.measure);
  Moments differences;
  for_each_pair(
      drives.of(index_of(sweep, expectation.less)), drives.of(index_of(sweep, expectation.than)),
      [&](const Row& one, const Row& other) { differences.add(drives.value(one, m) - drives.value(other, m)); });
  const Interval difference = difference_interval(sweep, m, differences);
  if (difference.below(0.0)) return {};
  if (difference.count < 2)
    return undecided(fmt::format("{} of both paradigms; more replications", counted(difference.count, "pair")));
  const std::string text = with_unit(interval_text(difference, true), expectation);
  return difference.above(0.0) ? Verdict{Outcome::kFails, "it is more, by " + text}
                               : undecided(fmt::format("the difference is {}; more replications", text));
}

ExpectationAnswer judge(const SweepFile& sweep, const Expectation& expectation, const results::Store& store) {
  ExpectationAnswer answer{expectation.text, Outcome::kHolds, {}};
  const std::vector<const Axis*> grid = sweep.grid();
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    const std::vector<const Setting*> settings = sweep.settings_of(point);
    bool meant = true;
    for (std::size_t a = 0; a < grid.size(); ++a)
      if (const auto label = expectation.where.find(grid[a]->name); label != expectation.where.end())
        meant = meant && label->second == settings[a]->label;
    if (!meant) continue;
    const PointDrives drives(sweep, store.of_point(point));
    Verdict verdict = expectation.agrees.empty() ? less(sweep, expectation, drives) : agree(sweep, expectation, drives);
    if (verdict.outcome == Outcome::kHolds) continue;
    if (answer.outcome != Outcome::kFails) answer.outcome = verdict.outcome;
    answer.unmet.push_back({sweep.label_of(point), std::move(verdict.why)});
  }
  return answer;
}

// The same replication of both paradigms before and after. A replication without all four values is left out.
std::vector<Quadruple> values_of(const Interaction& of, const PointDrives& before, const PointDrives& after) {
  std::vector<Quadruple> values;
  const auto add = [&](double first_before, double first_after, double second_before, double second_after) {
    if (std::isfinite(first_before) && std::isfinite(first_after) && std::isfinite(second_before) &&
        std::isfinite(second_after))
      values.push_back({first_before, first_after, second_before, second_after});
  };
  std::vector<const results::Row*> firsts, seconds;  // before; of replications that are there after, too
  std::vector<double> first_after, second_after;
  for_each_pair(before.of(of.first), after.of(of.first), [&](const results::Row& one, const results::Row& other) {
    firsts.push_back(&one);
    first_after.push_back(after.value(other, of.measure));
  });
  for_each_pair(before.of(of.second), after.of(of.second), [&](const results::Row& one, const results::Row& other) {
    seconds.push_back(&one);
    second_after.push_back(after.value(other, of.measure));
  });
  for (std::size_t f = 0, s = 0; f < firsts.size() && s < seconds.size();) {
    const std::uint32_t first = firsts[f]->key.replication, second = seconds[s]->key.replication;
    if (first == second)
      add(before.value(*firsts[f], of.measure), first_after[f], before.value(*seconds[s], of.measure), second_after[s]);
    f += first <= second;
    s += second <= first;
  }
  return values;
}

// The change of one paradigm; as pairs of the value after and the value before.
Change change_of(const Interaction& of, const std::vector<Quadruple>& values, bool first, double confidence) {
  std::vector<std::pair<double, double>> pairs;
  Moments differences;
  for (const Quadruple& one : values) {
    pairs.emplace_back(first ? one.first_after : one.second_after, first ? one.first_before : one.second_before);
    differences.add(pairs.back().first - pairs.back().second);
  }
  Change change{interval_of(differences, confidence), {}};
  if (of.scale == Scale::kRatio) change.ratio = results::ratio_of(pairs, confidence);
  return change;
}

// Answers each interaction of the file, once for all values of the other axes. All of them are one family.
std::vector<InteractionAnswer> interactions_of(const SweepFile& sweep, const results::Store& store) {
  std::vector<InteractionAnswer> answers;
  std::vector<results::Interval> all;
  for (const Interaction& of : sweep.interactions) {
    InteractionAnswer& answer = answers.emplace_back();
    for (std::uint32_t point = 0; point < sweep.points(); ++point) {
      if (sweep.moved(point, of.axis, of.before) != point) continue;
      const PointDrives before(sweep, store.of_point(point));
      const PointDrives after(sweep, store.of_point(sweep.moved(point, of.axis, of.after)));
      const std::vector<Quadruple> values = values_of(of, before, after);
      InteractionPoint& here = answer.points.emplace_back();
      here.point = point;
      here.first = change_of(of, values, true, sweep.confidence);
      here.second = change_of(of, values, false, sweep.confidence);
      here.interaction = of.scale == Scale::kRatio ? results::log_ratio_of_ratios(values, sweep.confidence)
                                                   : results::difference_of_differences(values, sweep.confidence);
      all.push_back(here.interaction);
    }
  }
  const results::Family family = results::family_of(all, sweep.confidence);
  auto stays = family.stays.begin();
  for (InteractionAnswer& answer : answers)
    for (InteractionPoint& here : answer.points) here.stays = *stays++;
  return answers;
}

// One measure of a paradigm minus that of its reference, and its ratio to it if that has a meaning.
void compare(const SweepFile& sweep, std::size_t measure, const PointDrives& drives, std::size_t paradigm,
             const PointDrives& others, std::size_t other_paradigm, Interval& difference, results::Ratio& ratio) {
  Moments differences;
  std::vector<std::pair<double, double>> pairs;
  for_each_pair(drives.of(paradigm), others.of(other_paradigm), [&](const Row& one, const Row& other) {
    const double x = drives.value(one, measure), y = others.value(other, measure);
    differences.add(x - y);
    if (std::isfinite(x) && std::isfinite(y)) pairs.emplace_back(x, y);
  });
  difference = difference_interval(sweep, measure, differences);
  if (is_ratio_scale(*find_measure(sweep.measures[measure]))) ratio = results::ratio_of(pairs, sweep.confidence);
}

// Adds the first measure's differences of all pairs of paradigms at a point.
void add_pairs(const SweepFile& sweep, std::uint32_t point, const PointDrives& drives,
               std::vector<results::PairedDifference>& pairs) {
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    for (std::size_t other = p + 1; other < sweep.paradigms.size(); ++other) {
      Moments differences;
      for_each_pair(drives.of(p), drives.of(other), [&](const Row& one, const Row& another) {
        differences.add(drives.value(one, 0) - drives.value(another, 0));
      });
      pairs.push_back({point, p, other, difference_interval(sweep, 0, differences), false});
    }
}

// `others` are the drives of the point's reference, or null if that is at the same point.
PointAnswer answer_at(const SweepFile& sweep, std::uint32_t point, const PointDrives& drives,
                      const PointDrives* others) {
  const std::size_t paradigms = sweep.paradigms.size(), measures = sweep.measures.size();
  PointAnswer answer{point, {}, {}, {}, {}};
  answer.means.assign(paradigms, std::vector<Interval>(measures));
  answer.differences = answer.means;
  answer.ratios.assign(paradigms, std::vector<results::Ratio>(measures));
  for (std::size_t p = 0; p < paradigms; ++p) {
    const auto reference = sweep.reference_of(point, p);
    for (std::size_t m = 0; m < measures; ++m) {
      Moments moments;
      for (const Row* row : drives.of(p)) moments.add(drives.value(*row, m));
      answer.means[p][m] = mean_interval(sweep, m, moments);
      if (reference)
        compare(sweep, m, drives, p, others != nullptr ? *others : drives, reference->paradigm,
                answer.differences[p][m], answer.ratios[p][m]);
    }
  }
  return answer;
}

// `drives_at` returns the drives of a point.
template <class DrivesAt>
void add_points(const SweepFile& sweep, const DrivesAt& drives_at, std::vector<PointAnswer>& points) {
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    const PointDrives drives = drives_at(point);
    const auto reference = sweep.compared_axis ? sweep.reference_of(point, 0) : std::nullopt;
    if (reference) {
      const PointDrives others = drives_at(reference->point);
      points.push_back(answer_at(sweep, point, drives, &others));
    } else {
      points.push_back(answer_at(sweep, point, drives, nullptr));
    }
  }
}

// Returns the replications at a point in which a drive lost a track, ascending.
std::vector<std::uint32_t> lost_at(const SweepFile& sweep, const PointDrives& drives, std::size_t measure) {
  std::vector<std::uint32_t> lost;
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    for (const Row* row : drives.of(p))
      if (drives.value(*row, measure) > 0.0) lost.push_back(row->key.replication);
  std::ranges::sort(lost);
  lost.erase(std::unique(lost.begin(), lost.end()), lost.end());
  return lost;
}

std::optional<LostTracks> lost_tracks(const SweepFile& sweep, const results::Store& store) {
  const std::size_t measure = measure_index(sweep, kTrackLost);  // if not the file's: the column behind them
  LostTracks all;
  all.drives.resize(sweep.paradigms.size());
  all.lost.resize(sweep.paradigms.size());
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    const PointDrives drives(sweep, store.of_point(point));
    all.left_out += lost_at(sweep, drives, measure).size();
    for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
      for (const Row* row : drives.of(p)) {
        all.drives[p] += !std::isnan(drives.value(*row, measure));
        all.lost[p] += drives.value(*row, measure) > 0.0;
      }
  }
  if (all.left_out == 0) return measure < sweep.measures.size() ? std::optional(all) : std::nullopt;
  const auto without = [&](std::uint32_t point) {
    std::vector<Row> rows = store.of_point(point);
    const std::vector<std::uint32_t> lost = lost_at(sweep, PointDrives(sweep, rows), measure);
    std::erase_if(rows, [&](const Row& row) { return std::ranges::binary_search(lost, row.key.replication); });
    return PointDrives(sweep, std::move(rows));
  };
  add_points(sweep, without, all.points);
  return all;
}

void judge_together(const SweepFile& sweep, SweepAnswer& answer) {
  std::vector<Interval> differences;
  for (const PointAnswer& point : answer.points)
    for (const auto& of_paradigm : point.differences) differences.push_back(of_paradigm.front());
  const results::Family family = results::family_of(differences, sweep.confidence);
  answer.comparisons = family.comparisons;
  answer.certain = family.certain;
  auto stays = family.stays.begin();
  for (PointAnswer& point : answer.points) {
    const auto end = stays + static_cast<std::ptrdiff_t>(sweep.paradigms.size());
    point.stays.assign(stays, end);
    stays = end;
  }
}

// Searches along one axis, from every point that has a neighbour on it.
void find_crossings(const SweepFile& sweep, std::size_t paradigm, std::size_t a, SweepAnswer& answer) {
  const std::vector<const Axis*> grid = sweep.grid();
  const Axis& axis = *grid[a];
  std::uint32_t stride = 1;
  for (std::size_t later = a + 1; later < grid.size(); ++later)
    stride *= static_cast<std::uint32_t>(grid[later]->settings.size());
  for (std::uint32_t point = 0; point + stride < answer.points.size(); ++point) {
    const std::vector<const Setting*> settings = sweep.settings_of(point), next = sweep.settings_of(point + stride);
    if (settings[a] + 1 != next[a] || !settings[a]->number || !next[a]->number) continue;
    const Interval before = answer.points[point].differences[paradigm].front();
    // Points without any difference are skipped: the other side is behind them.
    std::uint32_t behind = point + stride;
    const Setting* const last = &axis.settings.back();
    while (answer.points[behind].differences[paradigm].front().mean == 0.0 && sweep.settings_of(behind)[a] != last)
      behind += stride;
    const Interval after = answer.points[behind].differences[paradigm].front();
    if (!(before.mean * after.mean < 0.0)) continue;
    const double to = answer.points[point + stride].differences[paradigm].front().mean;
    const double part = before.mean / (before.mean - to), x = *settings[a]->number, y = *next[a]->number;
    answer.crossings.push_back({paradigm, axis.name, sweep.label_without(point, a), point, behind,
                                axis.logarithmic ? x * std::pow(y / x, part) : x + part * (y - x),
                                answer.points[point].stays[paradigm] && answer.points[behind].stays[paradigm]});
  }
}

}  // namespace

bool SweepAnswer::holds() const {
  return std::all_of(expectations.begin(), expectations.end(),
                     [](const ExpectationAnswer& one) { return one.holds(); });
}

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store) {
  SweepAnswer answer;
  std::vector<results::PairedDifference> pairs;
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    const PointDrives drives(sweep, store.of_point(point));
    answer.drives += drives.count();
    answer.failed += drives.failed();
    add_pairs(sweep, point, drives, pairs);
  }
  answer.pairs = results::judged_together(std::move(pairs), sweep.confidence);
  add_points(
      sweep, [&](std::uint32_t point) { return PointDrives(sweep, store.of_point(point)); }, answer.points);
  judge_together(sweep, answer);
  answer.lost = lost_tracks(sweep, store);
  for (std::size_t p = 0; p < sweep.paradigms.size() && !sweep.compared_axis; ++p)
    for (std::size_t a = 0; a < sweep.grid().size() && p != sweep.baseline; ++a) find_crossings(sweep, p, a, answer);
  answer.interactions = interactions_of(sweep, store);
  for (const Expectation& expectation : sweep.expectations)
    answer.expectations.push_back(judge(sweep, expectation, store));
  return answer;
}

bool sure_enough(const SweepFile& sweep, const std::vector<Row>& rows, std::uint32_t to) {
  std::vector<Row> first;
  for (const Row& row : rows)
    if (row.key.replication < to) first.push_back(row);
  const PointDrives drives(sweep, std::move(first));
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p) {
    if (p == sweep.baseline) continue;
    Moments differences;
    for_each_pair(drives.of(p), drives.of(sweep.baseline), [&](const Row& one, const Row& other) {
      differences.add(drives.value(one, 0) - drives.value(other, 0));
    });
    if (!(difference_interval(sweep, 0, differences).half_width <= sweep.stop->half_width)) return false;
  }
  return true;
}

}  // namespace ttf::experiments::sweep::answers
