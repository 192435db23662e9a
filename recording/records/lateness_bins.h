// The bins of records::LatenessHistogram, fixed so that histograms can be added. A bin is a microsecond wide up
// to 64 us; from there on each doubling has 32 bins (3 % wide), up to 67 s.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/time.h"

namespace ttf::recording::records {

inline constexpr std::size_t kLatenessBins = 64 + 20 * 32;

// Early counts as not late; anything later than the last bin counts in that bin.
constexpr std::size_t lateness_bin(Duration late) {
  if (late.ns <= 0) return 0;
  const auto us = static_cast<std::uint64_t>(late.ns) / 1000;
  if (us < 64) return us;
  const int octave = std::bit_width(us) - 7;  // 0: 64..127 us
  const std::size_t bin = 64 + static_cast<std::size_t>(octave) * 32 + ((us >> (octave + 1)) & 31);
  return bin < kLatenessBins ? bin : kLatenessBins - 1;
}

// Returns where the bin begins; it ends where the next begins.
constexpr Duration lateness_from(std::size_t bin) {
  if (bin < 64) return Duration::microseconds(static_cast<std::int64_t>(bin));
  const std::size_t octave = (bin - 64) / 32, step = (bin - 64) % 32;
  return Duration::microseconds(static_cast<std::int64_t>((32 + step) << (octave + 1)));
}

}  // namespace ttf::recording::records
