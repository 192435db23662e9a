#include "experiments/sweep/answers/expectations.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/results/equivalence.h"
#include "experiments/sweep/answers/figures.h"
#include "experiments/sweep/answers/point_drives.h"

namespace ttf::experiments::sweep::answers {
namespace {

using evaluation::measures::find_measure;

using results::Interval;
using results::Moments;
using results::Row;

std::size_t index_of(const SweepFile& sweep, const std::string& paradigm) {
  const auto found = std::find_if(sweep.paradigms.begin(), sweep.paradigms.end(),
                                  [&](const Paradigm& one) { return one.name == paradigm; });
  return static_cast<std::size_t>(found - sweep.paradigms.begin());
}

std::size_t measure_index(const SweepFile& sweep, const std::string& name) {
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

Verdict undecided(const std::string& why) { return {Outcome::kCannotTell, "cannot tell: " + why}; }

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

}  // namespace

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

}  // namespace ttf::experiments::sweep::answers
