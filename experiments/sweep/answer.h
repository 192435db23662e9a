// The answer of an experiment's results, a pure function of the store. It has means with intervals by point,
// paradigm and measure, and differences between paradigms of the same draws (paired, so that common effects
// cancel). It says where two paradigms cross, and whether the expectations hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/results/statistics.h"
#include "experiments/results/store.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

struct PointAnswer {
  std::uint32_t point = 0;
  // By paradigm, then measure. Differences are this paradigm's minus the baseline's, replication by
  // replication; the baseline has none.
  std::vector<std::vector<results::Interval>> means, differences;
  // By paradigm: the first measure's difference stays certain among all points' and paradigms' (Holm's method).
  std::vector<bool> stays;
};

// A change of sign of the first measure's difference between two neighbours on a numeric axis of the grid, all
// else equal. Points without any difference may lie between the two.
struct Crossing {
  std::size_t paradigm = 0;  // this one and the baseline
  std::string axis;
  std::string others;                   // the other axes' values, "" if there are none
  std::uint32_t before = 0, after = 0;  // points
  double at = 0.0;                      // interpolated: linear in the value, or in its logarithm on a logarithmic axis
  bool certain = false;                 // both differences stay certain by Holm's method
};

enum class Outcome : std::uint8_t { kHolds, kFails, kCannotTell };
std::string_view words(Outcome outcome);  // "holds"

// A point at which an expectation is not certain, with a sentence about the reason.
struct Unmet {
  std::string point, why;
};

struct ExpectationAnswer {
  std::string text;
  Outcome outcome = Outcome::kHolds;  // fails if it fails at one point
  std::vector<Unmet> unmet;
  bool holds() const { return outcome == Outcome::kHolds; }
};

struct SweepAnswer {
  std::uint64_t drives = 0, failed = 0;
  std::vector<PointAnswer> points;
  std::size_t comparisons = 0, certain = 0;  // the first measure's, at all points; those that stay certain
  std::vector<Crossing> crossings;
  std::vector<ExpectationAnswer> expectations;
  bool holds() const;
};

// "+0.0021 +- 0.0004", with two digits for the interval; "-" without a mean. `sign` marks a difference.
std::string interval_text(const results::Interval& interval, bool sign);

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store);

// Returns whether a point satisfies the stop rule with replications 0..to-1 of `rows`, which are in order.
bool sure_enough(const SweepFile& sweep, const std::vector<results::Row>& rows, std::uint32_t to);

}  // namespace ttf::experiments::sweep
