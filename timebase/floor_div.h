// Whole quotients of wide numbers.
#pragma once

#include <cstdint>

#include "core/int128.h"

namespace ttf::timebase {

// Returns the largest whole number at or below a / b, for b > 0. `a` nearly always fits 64 bits: then no wide
// division is needed.
constexpr Int128 floor_div(Int128 a, std::int64_t b) {
  const auto narrow = static_cast<std::int64_t>(a);
  if (narrow == a) return narrow / b - (narrow % b < 0 ? 1 : 0);
  return a / b - (a % b < 0 ? 1 : 0);
}

}  // namespace ttf::timebase
