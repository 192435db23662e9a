#include "experiments/sweep/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/counted.h"
#include "experiments/results/equivalence.h"
#include "experiments/results/multiplicity.h"
#include "experiments/sweep/measures.h"

namespace ttf::experiments::sweep {
namespace {

using results::Interval;
using results::Moments;
using results::Row;

// Sums a point's results, which come replication by replication.
class Sums {
 public:
  explicit Sums(const SweepFile& sweep, std::size_t other_than_baseline)
      : sweep_(sweep), against_(other_than_baseline), first_(sweep.drawn().size()),
        means_(sweep.paradigms.size(), std::vector<Moments>(sweep.measures.size())), differences_(means_),
        of_replication_(sweep.paradigms.size(), nullptr) {}

  void add(const Row& row) {
    if (row.key.replication != replication_) end_replication();
    replication_ = row.key.replication;
    if (row.status != results::kDone) return;
    kept_.push_back(row);
    for (std::size_t m = 0; m < sweep_.measures.size(); ++m) means_[row.key.paradigm][m].add(row.values[first_ + m]);
  }
  PointAnswer finish(std::uint32_t point) {
    end_replication();
    PointAnswer answer{point, {}, {}, {}};
    for (std::size_t p = 0; p < means_.size(); ++p) {
      answer.means.push_back(intervals(means_[p]));
      answer.differences.push_back(intervals(differences_[p]));
    }
    return answer;
  }

 private:
  void end_replication() {
    std::fill(of_replication_.begin(), of_replication_.end(), nullptr);
    for (const Row& row : kept_) of_replication_[row.key.paradigm] = &row;
    const Row* baseline = of_replication_[against_];
    for (std::size_t p = 0; p < differences_.size() && baseline != nullptr; ++p)
      if (const Row* row = of_replication_[p]; row != nullptr && p != against_)
        for (std::size_t m = 0; m < sweep_.measures.size(); ++m)
          differences_[p][m].add(row->values[first_ + m] - baseline->values[first_ + m]);
    kept_.clear();
  }
  std::vector<Interval> intervals(const std::vector<Moments>& moments) const {
    std::vector<Interval> all;
    for (const Moments& one : moments) all.push_back(interval_of(one, sweep_.confidence));
    return all;
  }

  const SweepFile& sweep_;
  std::size_t against_, first_;
  std::vector<std::vector<Moments>> means_, differences_;
  std::vector<const Row*> of_replication_;
  std::vector<Row> kept_;
  std::uint32_t replication_ = 0;
};

std::size_t index_of(const SweepFile& sweep, const std::string& paradigm) {
  const auto found = std::find_if(sweep.paradigms.begin(), sweep.paradigms.end(),
                                  [&](const Paradigm& one) { return one.name == paradigm; });
  return static_cast<std::size_t>(found - sweep.paradigms.begin());
}

void add_points(const SweepFile& sweep, const results::Store& store, SweepAnswer& answer) {
  for (std::uint32_t point = 0; point < sweep.points(); ++point) {
    Sums sums(sweep, sweep.baseline);
    for (const Row& row : store.of_point(point)) {
      sums.add(row);
      ++answer.drives;
      answer.failed += row.status != results::kDone;
    }
    answer.points.push_back(sums.finish(point));
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
    std::vector<std::string> others;
    for (std::size_t other = 0; other < grid.size(); ++other)
      if (other != a && grid[other]->settings.size() > 1)
        others.push_back(grid[other]->name + " " + settings[other]->label);
    answer.crossings.push_back({paradigm, axis.name, joined(others), point, behind,
                                axis.logarithmic ? x * std::pow(y / x, part) : x + part * (y - x),
                                answer.points[point].stays[paradigm] && answer.points[behind].stays[paradigm]});
  }
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
Verdict agree(const SweepFile& sweep, const Expectation& expectation, const std::vector<Row>& rows) {
  const std::size_t paradigm = index_of(sweep, expectation.less), first = sweep.drawn().size();
  const std::size_t one = measure_index(sweep, expectation.measure), other = measure_index(sweep, expectation.agrees);
  results::EquivalenceTest test(expectation.margin);
  for (const Row& row : rows)
    if (row.key.paradigm == paradigm && row.status == results::kDone)
      test.add(row.values[first + one], row.values[first + other]);
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

Verdict less(const SweepFile& sweep, const Expectation& expectation, const std::vector<Row>& rows) {
  Sums sums(sweep, index_of(sweep, expectation.than));
  for (const Row& row : rows) sums.add(row);
  const PointAnswer answer = sums.finish(0);
  const Interval& difference =
      answer.differences[index_of(sweep, expectation.less)][measure_index(sweep, expectation.measure)];
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
    const std::vector<Row> rows = store.of_point(point);
    Verdict verdict = expectation.agrees.empty() ? less(sweep, expectation, rows) : agree(sweep, expectation, rows);
    if (verdict.outcome == Outcome::kHolds) continue;
    if (answer.outcome != Outcome::kFails) answer.outcome = verdict.outcome;
    answer.unmet.push_back({sweep.label_of(point), std::move(verdict.why)});
  }
  return answer;
}

}  // namespace

std::string_view words(Outcome outcome) {
  switch (outcome) {
    case Outcome::kHolds: return "holds";
    case Outcome::kFails: return "does not hold";
    case Outcome::kCannotTell: break;
  }
  return "cannot tell";
}

std::string interval_text(const Interval& interval, bool sign) {
  if (std::isnan(interval.mean)) return "-";
  const double width = std::isnan(interval.half_width) ? std::abs(interval.mean) * 1e-3 : interval.half_width;
  const int decimals =
      width > 0.0 && std::isfinite(width) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(width))), 0, 9) : 3;
  std::string text =
      sign ? fmt::format("{:+.{}f}", interval.mean, decimals) : fmt::format("{:.{}f}", interval.mean, decimals);
  if (!std::isnan(interval.half_width)) text += fmt::format(" +- {:.{}f}", interval.half_width, decimals);
  return text;
}

bool SweepAnswer::holds() const {
  return std::all_of(expectations.begin(), expectations.end(),
                     [](const ExpectationAnswer& one) { return one.holds(); });
}

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store) {
  SweepAnswer answer;
  add_points(sweep, store, answer);
  judge_together(sweep, answer);
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    for (std::size_t a = 0; a < sweep.grid().size() && p != sweep.baseline; ++a) find_crossings(sweep, p, a, answer);
  for (const Expectation& expectation : sweep.expectations)
    answer.expectations.push_back(judge(sweep, expectation, store));
  return answer;
}

bool sure_enough(const SweepFile& sweep, const std::vector<Row>& rows, std::uint32_t to) {
  Sums sums(sweep, sweep.baseline);
  for (const Row& row : rows)
    if (row.key.replication < to) sums.add(row);
  const PointAnswer answer = sums.finish(0);
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    if (p != sweep.baseline && !(answer.differences[p].front().half_width <= sweep.stop->half_width)) return false;
  return true;
}

}  // namespace ttf::experiments::sweep
