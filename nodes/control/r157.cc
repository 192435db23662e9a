#include "nodes/control/r157.h"

#include <algorithm>

namespace ttf::nodes::control {
namespace {

constexpr double kSlow_mps = 10.0 / 3.6, kHundred_kmh_mps = 100.0 / 3.6;
constexpr double kShortest_m = 2.0;

}  // namespace

double minimum_following_distance(double speed) {
  const double gap = speed < kSlow_mps ? 1.0 + (std::max(2.0, speed) - 2.0) / 7.8 : 1.0 + speed / kHundred_kmh_mps;
  return std::max(kShortest_m, gap * speed);
}

}  // namespace ttf::nodes::control
