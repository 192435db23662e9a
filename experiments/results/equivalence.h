// Whether two measures of the same drives are equal within a margin.
#pragma once

#include <cmath>
#include <cstdint>

#include "experiments/results/statistics.h"

namespace ttf::experiments::results {

struct Margin {
  double value = 0.1;
  bool share = true;  // a share of the second measure; otherwise in the measures' unit

  // Returns the margin around a value of the second measure.
  double around(double second) const { return share ? value * std::abs(second) : value; }
};

// kUndecided: the drives cannot decide.
enum class Agreement : std::uint8_t { kWithin, kBeyond, kUndecided };

// Two one-sided tests of paired values x and y with margin m (Schuirmann: "A comparison of the two one-sided tests
// procedure and the power approach for assessing the equivalence of average bioavailability", 1987):
//   within if x - y - m is below 0 and x - y + m above 0, both for certain,
//   beyond if one of them is on its other side for certain.
// A share is taken drive by drive, m = share |y|, so that both tests include how sure the margin itself is. Each test
// errs with a probability of at most (1 - confidence) / 2. Fewer than two pairs are undecided.
class EquivalenceTest {
 public:
  explicit EquivalenceTest(Margin margin) : margin_(margin) {}

  void add(double x, double y);
  Agreement agreement(double confidence) const;
  const Moments& difference() const { return difference_; }  // x - y
  double margin() const { return margins_.mean(); }          // on the average

 private:
  Margin margin_;
  Moments difference_, above_, below_, margins_;
};

}  // namespace ttf::experiments::results
