// Draws signals like those of a published packing problem: shares of periods, lengths, windows and nodes as in
// `HW_Verification` of Dvorak and Hanzalek (docs/schedules/packing.md), which this repository does not contain.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "core/random.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

// Draws an index with a probability in proportion to its weight.
template <std::size_t kCount> int drawn_index(const std::array<int, kCount>& weights, RandomStream& random) {
  std::int64_t left = random.integer(0, std::accumulate(weights.begin(), weights.end(), std::int64_t{0}) - 1);
  for (std::size_t i = 0; i < kCount; ++i)
    if ((left -= weights[i]) < 0) return static_cast<int>(i);
  return static_cast<int>(kCount) - 1;
}

// 6 nodes, frames of 32 bits, 64 cycles. `windows` is the percentage of signals with a window among those of longer
// periods.
inline Instance like_instance(int signals, std::uint64_t seed, int windows = 12) {
  constexpr std::array kPeriods{583, 491, 297, 1619, 606, 250, 250};     // 1, 2, 4, ..., 64 cycles
  constexpr std::array kLengths{1409, 807, 501, 77, 78, 425, 160, 639};  // 1..8 bits
  constexpr std::array kNodes{855, 956, 851, 464, 501, 469};
  RandomStream random({seed, 0, Purpose::kTest});
  Instance instance{{"1", "2", "3", "4", "5", "6"}, {}, 32, kMostCycles, false};
  for (int i = 0; i < signals; ++i) {
    Signal signal{std::to_string(i), drawn_index(kNodes, random), 1 << drawn_index(kPeriods, random), {}, 1};
    signal.bits = 1 + drawn_index(kLengths, random);
    signal.window = {0, signal.repetition - 1};
    if (signal.repetition > 1 && random.integer(1, 100) <= windows) {
      signal.window.earliest = static_cast<int>(random.integer(0, std::min(5, signal.repetition - 1)));
      signal.window.latest = static_cast<int>(random.integer(signal.window.earliest, signal.repetition - 1));
    }
    instance.signals.push_back(signal);
  }
  return instance;
}

}  // namespace ttf::schedules::packing
