// Durations counted in the bins of recording/records/lateness_bins.h: any number of them takes the same few
// kilobytes.
//
// Quantiles are those of the sorted list, nearest rank: of n durations the q-quantile is the ceil(q n)-th
// smallest. The returned value is the end of its bin, or the longest duration if that is less. It is never
// below the exact quantile, and above it by a bin at most (1 us up to 64 us, 3 % from there on).
//
// No heap: a real-time thread may count with it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/int128.h"
#include "core/time.h"
#include "recording/records/lateness_bins.h"

namespace ttf::recording::records {

class BinnedDurations {
 public:
  BinnedDurations() = default;
  // From a histogram's counts; bins beyond the last one are ignored.
  BinnedDurations(std::span<const std::uint64_t> counts, Duration longest) : longest_(longest) {
    std::copy_n(counts.begin(), std::min(counts.size(), kLatenessBins), counts_.begin());
    empty_ = count() == 0;
  }

  void add(Duration one) {
    longest_ = empty_ ? one : std::max(longest_, one);
    empty_ = false;
    std::uint64_t& count = counts_[lateness_bin(one)];
    count = sum(count, 1);
  }
  void add(const BinnedDurations& others) {
    if (others.empty_) return;
    longest_ = empty_ ? others.longest_ : std::max(longest_, others.longest_);
    empty_ = false;
    for (std::size_t bin = 0; bin < kLatenessBins; ++bin) counts_[bin] = sum(counts_[bin], others.counts_[bin]);
  }

  bool empty() const { return empty_; }
  std::uint64_t count() const { return count_from(0); }
  // Returns how many durations are at least lateness_from(bin); bin 0 also holds those that are not late.
  std::uint64_t count_from(std::size_t bin) const {
    std::uint64_t all = 0;
    for (; bin < kLatenessBins; ++bin) all = sum(all, counts_[bin]);
    return all;
  }
  Duration longest() const { return longest_; }  // 0 if empty

  // In thousandths: 500 is the median, 999 the duration that one in a thousand exceeds. 0 if empty.
  Duration quantile(int thousandths) const {
    const auto rank = static_cast<std::uint64_t>((UInt128{count()} * static_cast<unsigned>(thousandths) + 999) / 1000);
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin + 1 < kLatenessBins; ++bin) {
      below = sum(below, counts_[bin]);
      if (below >= rank && below > 0) return std::min(lateness_from(bin + 1), longest_);
    }
    return longest_;
  }

  // By bin, up to the last bin that is not empty, as records::LatenessHistogram has them.
  std::span<const std::uint64_t> counts() const {
    std::size_t size = kLatenessBins;
    while (size > 0 && counts_[size - 1] == 0) --size;
    return std::span(counts_).first(size);
  }

 private:
  // Saturates: numbers in a damaged log may have any value.
  static constexpr std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return a > std::numeric_limits<std::uint64_t>::max() - b ? std::numeric_limits<std::uint64_t>::max() : a + b;
  }

  std::array<std::uint64_t, kLatenessBins> counts_{};
  Duration longest_{};
  bool empty_ = true;
};

}  // namespace ttf::recording::records
