// Ratios of means over the same drives: effects in per cent, and interactions of two effects.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "experiments/results/statistics.h"

namespace ttf::experiments::results {

// The ratio of two means, with the ends of its interval. The ends are not numbers if the samples do not bound it.
struct Ratio {
  std::uint64_t count = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

// Returns mean(x) / mean(y) of paired samples (x, y) from quantities that cannot be negative (Fieller: "Some problems in
// interval estimation", Journal of the Royal Statistical Society B 16, 1954). The interval has all r for which Student's
// test of x - r y does not exclude 0. So it excludes 1 exactly where the interval of the difference x - y excludes 0. There
// is none for fewer than two pairs, for a mean that is not above 0, and if y's own interval reaches 0. All values are finite.
Ratio ratio_of(std::span<const std::pair<double, double>> pairs, double confidence);

// One replication's values in an interaction: two paradigms, each before and after a change.
struct Quadruple {
  double first_before = 0.0, first_after = 0.0, second_before = 0.0, second_after = 0.0;
};

// Returns the mean of (first_after - first_before) - (second_after - second_before), in the values' unit.
Interval difference_of_differences(std::span<const Quadruple> values, double confidence);

// Returns the natural logarithm of (mean(first_after) / mean(first_before)) / (mean(second_after) / mean(second_before)):
// below 0 if the change leaves a smaller share of the first than of the second. The width is the jackknife's: Student's t of
// the logarithms without one replication each (Miller: "The jackknife - a review", Biometrika 61, 1974). With values that
// spread by their own size, 95 % intervals cover 93 to 95 % from twenty replications on. Both sides swapped give the same
// interval with the other sign. The mean is not a number unless all four means are above 0. There is no width unless they are
// so without any one replication.
Interval log_ratio_of_ratios(std::span<const Quadruple> values, double confidence);
// Returns the ratio whose natural logarithm has this interval.
Ratio exponential(const Interval& logarithm);

}  // namespace ttf::experiments::results
