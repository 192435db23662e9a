// The answer of an experiment's results, a pure function of the store. It has means with intervals by point,
// paradigm and measure, and differences between paradigms of the same draws (paired, so that common effects
// cancel). It says where two paradigms cross, and whether the expectations hold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
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
};

// A change of sign of the first measure's difference between two neighbours on a numeric axis of the grid, all
// else equal. Points without any difference may lie between the two.
struct Crossing {
  std::size_t paradigm = 0;  // this one and the baseline
  std::string axis;
  std::string others;                   // the other axes' values, "" if there are none
  std::uint32_t before = 0, after = 0;  // points
  double at = 0.0;                      // interpolated: linear in the value, or in its logarithm on a logarithmic axis
  bool certain = false;                 // the intervals of both exclude 0
};

struct ExpectationAnswer {
  std::string text;
  bool holds = false;
  std::vector<std::string> where_not;  // points at which the expectation fails or is not certain
};

struct SweepAnswer {
  std::uint64_t drives = 0, failed = 0;
  std::vector<PointAnswer> points;
  std::vector<Crossing> crossings;
  std::vector<ExpectationAnswer> expectations;
  bool holds() const;
};

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store);

// Returns whether a point satisfies the stop rule with replications 0..to-1 of `rows`, which are in order.
bool sure_enough(const SweepFile& sweep, const std::vector<results::Row>& rows, std::uint32_t to);

}  // namespace ttf::experiments::sweep
