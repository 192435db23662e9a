// The instants at which the schedule has a sensor measure: first, first + period, ...
#pragma once

#include <cstdint>
#include <optional>

#include "core/time.h"

namespace ttf::fusion::strategies {

struct ScheduledInstants {
  GlobalTime first{};
  Duration period{};  // longer than nothing

  // Time stamps are clock readings: an instant of the schedule is recognised within a quarter of the period.
  Duration tolerance() const { return {period.ns / 4}; }

  // The instant that a time stamp is of; nothing where it fits none.
  std::optional<GlobalTime> of(GlobalTime stamp) const {
    const std::int64_t since = (stamp - first).ns + period.ns / 2;
    const std::int64_t cycle = since >= 0 ? since / period.ns : -((period.ns - 1 - since) / period.ns);
    const GlobalTime instant = first + period * cycle;
    const Duration off = stamp - instant;
    if (off > tolerance() || -off > tolerance()) return std::nullopt;
    return instant;
  }
  // The newest that is not after `time`, which is not before the first.
  GlobalTime newest_at(GlobalTime time) const { return first + period * ((time - first).ns / period.ns); }
};

}  // namespace ttf::fusion::strategies
