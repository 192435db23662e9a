// Samples of a position plot by time.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "report/plots/position_plot.h"

namespace ttf::report::plots {

inline bool earlier(const PositionPlots::Sample& a, const PositionPlots::Sample& b) { return a.t < b.t; }

// Sorts samples by time: the records of a log may be ordered by process.
inline std::vector<PositionPlots::Sample> by_time(std::vector<PositionPlots::Sample> samples) {
  std::ranges::stable_sort(samples, earlier);
  return samples;
}

// Interpolates linearly in samples ordered by time; no value outside them (by more than `slack`).
inline std::optional<PositionPlots::Sample> interpolate(const std::vector<PositionPlots::Sample>& samples, double t,
                                                        double slack) {
  if (samples.empty() || t < samples.front().t - slack || t > samples.back().t + slack) return std::nullopt;
  const auto after = std::ranges::lower_bound(samples, t, {}, &PositionPlots::Sample::t);
  if (after == samples.begin()) return samples.front();
  if (after == samples.end()) return samples.back();
  const PositionPlots::Sample &a = *(after - 1), &b = *after;
  const double f = b.t > a.t ? (t - a.t) / (b.t - a.t) : 0;
  return PositionPlots::Sample{t, a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), {}};
}

}  // namespace ttf::report::plots
