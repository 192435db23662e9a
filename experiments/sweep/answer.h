// What an experiment's runs say: means with intervals by point, paradigm and measure, differences between paradigms of
// the same draws (paired, so that what all of them suffer from cancels), where two of them cross, and whether what was
// expected came out. A pure function of the store.
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
  // By paradigm, then measure. Differences are of this paradigm from the baseline, replication by replication; of the
  // baseline itself there are none.
  std::vector<std::vector<results::Interval>> means, differences;
};

// Between two neighbours on a numeric axis of the grid, all else equal, the first measure's difference changes its
// sign; or between two points with others between them at which there is no difference at all.
struct Crossing {
  std::size_t paradigm = 0;  // it and the baseline
  std::string axis;
  std::string others;                   // the other axes' values, "" if there are none
  std::uint32_t before = 0, after = 0;  // points
  double at = 0.0;       // interpolated: linear in the value, or in its logarithm where the axis is logarithmic
  bool certain = false;  // the intervals of both exclude 0
};

struct ExpectationAnswer {
  std::string text;
  bool holds = false;
  std::vector<std::string> where_not;  // points at which it is otherwise or not certain
};

struct SweepAnswer {
  std::uint64_t runs = 0, failed = 0;
  std::vector<PointAnswer> points;
  std::vector<Crossing> crossings;
  std::vector<ExpectationAnswer> expectations;
  bool holds() const;
};

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store);

// Whether the stop rule is content with what there is of a point: replications 0..to-1 of `runs`, in order.
bool sure_enough(const SweepFile& sweep, const std::vector<results::Run>& runs, std::uint32_t to);

}  // namespace ttf::experiments::sweep
