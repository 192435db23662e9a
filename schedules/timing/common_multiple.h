// The least common multiple of two periods, where it is short enough to be of use.
#pragma once

#include <cstdint>
#include <numeric>
#include <optional>

#include "core/int128.h"

namespace ttf::schedules::timing {

// Takes positive numbers. Returns none beyond `most`.
constexpr std::optional<std::int64_t> common_multiple(std::int64_t a, std::int64_t b, std::int64_t most) {
  const Int128 product = Int128{a} / std::gcd(a, b) * b;
  if (product > most) return std::nullopt;
  return static_cast<std::int64_t>(product);
}

}  // namespace ttf::schedules::timing
