// The lists that have certainly arrived at a fusion instant. With this bound a fusion node stops waiting for a
// missing list at the first fusion instant by which it must have arrived, and not earlier.
//
// A list measured at m enters the first stage of its path on the cycle's grid (its slots, or the fusing task
// itself) by m + W. W is the sum of the worst cases before that stage. From there the latest way is a step
// function of the entry, with a step behind every instant of that stage. A list that enters at such an instant g
// is read at the fusion instant a(g) at the latest. A list that enters after g may be read an instant later. So
// at a(g), and not before, every list stamped
//   m(g) = g - W - (clocks apart) - (stamp)
// or earlier has arrived or never will. Stages, worst cases and the clocks' difference are those of
// schedules/analysis/ages.h, with its assumptions A1, A2 and A4. A stamp is the reading of a clock, at most a
// macrotick old, rounded to a microsecond: the last term.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// From the fusion instant `at` on, all lists of measurements stamped `measured` or earlier have arrived.
struct Settled {
  GlobalTime at{};
  GlobalTime measured{};
  bool operator==(const Settled&) const = default;
};

struct SettledRound {
  std::vector<Settled> instants;  // strictly increasing in both; without fusion instants that settle nothing new
  Duration round{};  // period of the instants: a round of cycles, or the multiple that is whole nanoseconds
  bool operator==(const SettledRound&) const = default;
};

// Returns nullopt for a sensor whose lists reach no fusing task, or one that time does not activate. The cluster
// must have passed check().
std::optional<SettledRound> settled_round(const model::Cluster& cluster, SensorId sensor);

}  // namespace ttf::schedules::analysis
