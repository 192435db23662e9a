// Divides by a constant without a division: exact, and several times as fast.
#pragma once

#include <cstdint>

#include "core/check.h"
#include "core/int128.h"

namespace ttf::timebase {

class Divisor {
 public:
  // The divisor is 1 or more.
  explicit constexpr Divisor(std::int64_t divisor)
      : divisor_(checked(divisor)), reciprocal_(~std::uint64_t{0} / divisor_) {}

  // Returns floor(x / divisor) for x >= 0. With r = 2^64 / d - e, 0 < e <= 1, the product x r / 2^64 is more
  // than x / d - 1. Its whole part is the quotient or one less; the remainder decides.
  constexpr std::int64_t floor(std::int64_t x) const {
    const auto u = static_cast<std::uint64_t>(x);
    auto quotient = static_cast<std::uint64_t>((static_cast<UInt128>(u) * reciprocal_) >> 64);
    if (u - quotient * divisor_ >= divisor_) ++quotient;
    return static_cast<std::int64_t>(quotient);
  }
  // Returns the least whole number at or above x / divisor, for x >= 0; x + divisor must not overflow.
  constexpr std::int64_t ceil(std::int64_t x) const { return floor(x + static_cast<std::int64_t>(divisor_) - 1); }

 private:
  static constexpr std::uint64_t checked(std::int64_t divisor) {
    TTF_CHECK(divisor >= 1, "divisor {}", divisor);
    return static_cast<std::uint64_t>(divisor);
  }
  std::uint64_t divisor_, reciprocal_;
};

}  // namespace ttf::timebase
