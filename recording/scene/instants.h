// Instants that a log may hold: a damaged one may have any times. Within 36 years arithmetic does not overflow.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::recording::scene {

inline constexpr std::int64_t kReach_ns = std::int64_t{1} << 60;
constexpr bool within_reach(std::int64_t ns) { return ns >= -kReach_ns && ns <= kReach_ns; }
// Returns the time as a picture shows it: earlier times stand at the start of the drive.
constexpr TrueTime shown(TrueTime at) { return {at.ns < 0 ? 0 : at.ns > kReach_ns ? kReach_ns : at.ns}; }

// A node's global time differs at most so much from its record's own instant, in every sound log.
inline constexpr Duration kNear = Duration::milliseconds(2000);
// Returns the true time of a node's global time; that of the record itself if the two are not near.
constexpr TrueTime instant_of(const records::Stamp& stamp, GlobalTime at) {
  if (!within_reach(stamp.true_time.ns) || !within_reach(stamp.global.ns) || !within_reach(at.ns))
    return shown(stamp.true_time);
  const Duration ahead = at - stamp.global;
  return shown(ahead > kNear || ahead < -kNear ? stamp.true_time : stamp.true_time + ahead);
}

}  // namespace ttf::recording::scene
