// The instants at which the schedule lets a sensor measure: first, first + period, ...
#pragma once

#include <cstdint>
#include <optional>

#include "core/time.h"

namespace ttf::fusion::strategies {

struct ScheduledInstants {
  GlobalTime first{};
  Duration period{};  // above zero

  // Time stamps are clock readings, so a stamp matches an instant within a quarter of the period.
  Duration tolerance() const { return {period.ns / 4}; }

  // Returns the instant of a time stamp, or no value if none matches.
  std::optional<GlobalTime> of(GlobalTime stamp) const {
    const std::int64_t since = (stamp - first).ns + period.ns / 2;
    const std::int64_t cycle = since >= 0 ? since / period.ns : -((period.ns - 1 - since) / period.ns);
    const GlobalTime instant = first + period * cycle;
    const Duration off = stamp - instant;
    if (off > tolerance() || -off > tolerance()) return std::nullopt;
    return instant;
  }
  // Returns the newest instant not after `time`, which is not before the first.
  GlobalTime newest_at(GlobalTime time) const { return first + period * ((time - first).ns / period.ns); }
};

}  // namespace ttf::fusion::strategies
