// Short names of durations.
#pragma once

#include "core/time.h"

namespace ttf::schedules {

constexpr Duration ms(std::int64_t n) { return Duration::milliseconds(n); }
constexpr Duration us(std::int64_t n) { return Duration::microseconds(n); }

}  // namespace ttf::schedules
