#include "timebase/clock_sync.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::timebase {
namespace {

// The smaller of the channels that saw the frame (FlexRay 2.1A, 8.6.2).
std::optional<int> smaller(const SyncDeviation& deviation) {
  if (deviation.a && deviation.b) return std::min(*deviation.a, *deviation.b);
  return deviation.a ? deviation.a : deviation.b;
}

Correction limited(int value, int limit) {
  Correction correction;
  correction.value = std::clamp(value, -limit, limit);
  correction.limit_reached = correction.value != value;
  return correction;
}

}  // namespace

std::optional<int> fault_tolerant_midpoint(std::span<int> deviations) {
  if (deviations.empty()) return std::nullopt;
  std::sort(deviations.begin(), deviations.end());
  const std::size_t k = deviations.size() > 7 ? 2 : deviations.size() > 2 ? 1 : 0;
  return (deviations[k] + deviations[deviations.size() - 1 - k]) / 2;
}

Correction offset_correction(std::span<const SyncDeviation> deviations, int limit) {
  TTF_CHECK(deviations.size() <= kMaxSyncNodes, "{} sync nodes", deviations.size());
  std::array<int, kMaxSyncNodes> values{};
  std::size_t count = 0;
  for (const SyncDeviation& deviation : deviations)
    if (const auto value = smaller(deviation)) values[count++] = *value;
  const auto midpoint = fault_tolerant_midpoint({values.data(), count});
  if (!midpoint) return {0, true, false};
  return limited(*midpoint, limit);
}

Correction rate_correction(const SyncMeasurements& measured, int previous, int damping, int limit) {
  std::array<int, kMaxSyncNodes> values{};
  std::size_t count = 0;
  for (int e = 0; e < measured.even_count; ++e) {
    const SyncDeviation& even = measured.even[static_cast<std::size_t>(e)];
    for (int o = 0; o < measured.odd_count; ++o) {
      const SyncDeviation& odd = measured.odd[static_cast<std::size_t>(o)];
      if (odd.frame_id != even.frame_id) continue;
      int sum = 0, channels = 0;
      if (even.a && odd.a) sum += *odd.a - *even.a, ++channels;
      if (even.b && odd.b) sum += *odd.b - *even.b, ++channels;
      if (channels > 0) values[count++] = sum / channels;
      break;   // one frame id, one entry
    }
  }
  const auto midpoint = fault_tolerant_midpoint({values.data(), count});
  if (!midpoint) return {previous, true, false};
  int rate = previous + *midpoint;
  // Damping towards zero keeps the cluster as a whole from drifting off together.
  if (rate > damping)
    rate -= damping;
  else if (rate < -damping)
    rate += damping;
  else
    rate = 0;
  return limited(rate, limit);
}

}  // namespace ttf::timebase
