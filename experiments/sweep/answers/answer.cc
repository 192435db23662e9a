#include "experiments/sweep/answers/answer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/measures/measure.h"
#include "experiments/results/multiplicity.h"
#include "experiments/sweep/answers/expectations.h"
#include "experiments/sweep/answers/interactions.h"
#include "experiments/sweep/answers/point_drives.h"

namespace ttf::experiments::sweep::answers {
namespace {

using evaluation::measures::find_measure;

using results::Interval;
using results::Moments;
using results::Row;

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

void add_points(const SweepFile& sweep, const results::Store& store, SweepAnswer& answer) {
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    const PointDrives drives(sweep, store.of_point(point));
    answer.drives += drives.count();
    answer.failed += drives.failed();
    const auto reference = sweep.compared_axis ? sweep.reference_of(point, 0) : std::nullopt;
    if (reference) {
      const PointDrives others(sweep, store.of_point(reference->point));
      answer.points.push_back(answer_at(sweep, point, drives, &others));
    } else {
      answer.points.push_back(answer_at(sweep, point, drives, nullptr));
    }
  }
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
  add_points(sweep, store, answer);
  judge_together(sweep, answer);
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
