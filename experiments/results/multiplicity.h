// Many comparisons at once: even one false verdict among them must be rare.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "experiments/results/statistics.h"

namespace ttf::experiments::results {

// The two-sided probability of a mean at least as far from 0, if the expectation is 0: Student's t. `confidence` is the
// interval's. Returns NaN for fewer than two samples.
double p_value(const Interval& interval, double confidence);

// Returns which comparisons stay certain together, by Holm's method ("A simple sequentially rejective multiple test
// procedure", Scandinavian Journal of Statistics 6, 1979). In the order of their p-values, the k-th of n, from 0 on, is
// held against level / (n - k). The first one above it is not certain, nor are those behind it. The probability of any
// false verdict is at most `level`, however the comparisons depend on each other. A value that is not a number is no
// comparison.
std::vector<bool> holm(std::span<const double> p_values, double level);

// Differences that were compared with 0, as one family.
struct Family {
  std::size_t comparisons = 0, certain = 0;
  std::vector<bool> stays;  // by difference: certain together with the others
};
// The probability of any false verdict is at most 1 - confidence.
Family family_of(std::span<const Interval> differences, double confidence);

}  // namespace ttf::experiments::results
