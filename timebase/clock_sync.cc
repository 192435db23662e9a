#include "timebase/clock_sync.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::timebase {
namespace {

// Returns the smaller deviation of the channels that saw the frame (FlexRay 2.1A, 8.6.2).
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

// Insertion sort: for so few values std::sort takes longer.
void sort(std::span<int> values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    const int value = values[i];
    std::size_t at = i;
    for (; at > 0 && values[at - 1] > value; --at) values[at] = values[at - 1];
    values[at] = value;
  }
}

// Returns the odd cycle's entry of the even cycle's frame number `index`. Each frame id has one entry, mostly at
// the same index.
const SyncDeviation* odd_of(const SyncMeasurements& measured, int index) {
  const int frame_id = measured.even[static_cast<std::size_t>(index)].frame_id;
  const auto begin = measured.odd.begin(), end = begin + measured.odd_count;
  if (index < measured.odd_count && begin[index].frame_id == frame_id) return &begin[index];
  const auto found = std::find_if(begin, end, [&](const SyncDeviation& odd) { return odd.frame_id == frame_id; });
  return found != end ? &*found : nullptr;
}

}  // namespace

std::optional<int> fault_tolerant_midpoint(std::span<int> deviations) {
  if (deviations.empty()) return std::nullopt;
  sort(deviations);
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
    const SyncDeviation* odd = odd_of(measured, e);
    if (odd == nullptr) continue;
    int sum = 0, channels = 0;
    if (even.a && odd->a) sum += *odd->a - *even.a, ++channels;
    if (even.b && odd->b) sum += *odd->b - *even.b, ++channels;
    if (channels > 0) values[count++] = sum / channels;
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
