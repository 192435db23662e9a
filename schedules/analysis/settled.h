// What has arrived at a fusion instant for certain: the schedule's promise that lets a fusion node stop waiting for a
// list that is missing, at the first fusion instant at which it must be there if it is ever to come, and at none
// before.
//
// A list measured at m enters the first stage of its path that is on the cycle's grid (its slots, or the fusing task
// itself) at m + W at the latest, W the sum of the worst cases before it. From there on the latest way is a step
// function of the entry, with a step behind every instant of that stage: what enters at such an instant g at the latest
// is read at the fusion instant a(g) at the latest, what enters behind it may be read an instant later. So at a(g), and
// not before, everything that is stamped
//   m(g) = g - W - (clocks apart) - (stamp)
// or earlier has arrived or never will. Stages, worst cases and the clocks' distance are those of
// schedules/analysis/ages.h, its assumptions A1, A2 and A4 included. A stamp is the reading of a clock, at most a
// macrotick old, rounded to a microsecond: the last term.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// At the fusion instant `at` and after it, all lists of measurements stamped `measured` or earlier have arrived.
struct Settled {
  GlobalTime at{};
  GlobalTime measured{};
  bool operator==(const Settled&) const = default;
};

struct SettledRound {
  std::vector<Settled> instants;  // strictly increasing in both; fusion instants that settle nothing new are left out
  Duration round{};               // after which they repeat: 64 cycles, or as many more as make whole nanoseconds
  bool operator==(const SettledRound&) const = default;
};

// Nothing for a sensor whose lists reach no fusing task, or one that time does not activate. The cluster must have
// passed check().
std::optional<SettledRound> settled_round(const model::Cluster& cluster, SensorId sensor);

}  // namespace ttf::schedules::analysis
