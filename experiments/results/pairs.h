// Comparisons of all pairs of paradigms at all points, as one family, and their wording.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "experiments/results/multiplicity.h"
#include "experiments/results/statistics.h"

namespace ttf::experiments::results {

// Two paradigms at a point. Point and paradigms are places in the experiment's lists.
struct PairedDifference {
  std::size_t point = 0, one = 0, other = 0;
  Interval difference;  // `one` minus `other`, paired by replication
  bool stays = false;   // certain together with all others, by Holm's method
};
struct Pairs {
  std::vector<PairedDifference> all;  // by point
  Family family;
};

// Sets `stays` of each pair. The probability of any false verdict is at most 1 - confidence.
Pairs judged_together(std::vector<PairedDifference> pairs, double confidence);

// Names each two paradigms with certain differences: "adva less than buff at 0.1 m and at 40 m; tt less than buff at 5 of 9
// points". Up to three points are named, more are counted. A single point has no name. Returns "" if no pair is certain.
std::string certain_pairs(const Pairs& pairs, std::span<const std::string> paradigms,
                          std::span<const std::string> points);

}  // namespace ttf::experiments::results
