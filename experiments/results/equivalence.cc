#include "experiments/results/equivalence.h"

namespace ttf::experiments::results {

void EquivalenceTest::add(double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  const double margin = margin_.around(y);
  difference_.add(x - y);
  above_.add(x - y - margin);
  below_.add(x - y + margin);
  margins_.add(margin);
}

Agreement EquivalenceTest::agreement(double confidence) const {
  const Interval above = interval_of(above_, confidence), below = interval_of(below_, confidence);
  if (above.below(0.0) && below.above(0.0)) return Agreement::kWithin;
  return above.above(0.0) || below.below(0.0) ? Agreement::kBeyond : Agreement::kUndecided;
}

}  // namespace ttf::experiments::results
