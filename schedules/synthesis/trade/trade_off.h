// The price of a smaller age in a plan: the length of the cycle and the rates of its sensors, and the static slots in use.
//
//   by candidate  the least worst age over the chains, its bound, and the fewest slots that allow it
//   the front     over all candidates: the fewest slots in use, and the least worst age that so many slots allow. Fewer slots
//                 make an age no smaller, so the front falls in steps
//
// "Slots in use" is the number of the last static slot in use, the objective `slots`. Ages are those that `schedule check` bounds, at
// first use. Where the search (placement.h) was cut, the bound is below the value. Everything ends by a
// count of steps.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::trade {

using instants::Candidate;

// Judges a cluster that passed the check, such as by its expected error. May be empty.
using Judge = std::function<double(const model::Cluster&)>;

struct TradeOffPoint {
  Candidate candidate;
  Duration worst_age{}, bound{};  // no instants of the same choice have a smaller worst age than the bound
  int slots = 0;                  // the last one in use
  bool fewest = false;            // proven: no fewer slots allow this age
  int static_slots = 0;           // the cycle's
  std::optional<double> judged;
  bool proven() const { return worst_age == bound; }
};

struct TradeOff {
  std::vector<TradeOffPoint> candidates;  // those with instants that pass the check, in the order of candidates()
  std::vector<TradeOffPoint> front;       // many slots first; each with the candidate that reaches it
  std::size_t without = 0;                // candidates without a point
  bool complete = true;                   // else the steps ended before the front did
  std::int64_t steps = 0;                 // placements tried
};

inline constexpr std::int64_t kMostTradeOffSteps = 30'000'000;

// The plan must have passed synthesize(), which refuses contradictions.
TradeOff trade_off(const plan::Plan& plan, const Judge& judge = {}, std::int64_t most_steps = kMostTradeOffSteps);

}  // namespace ttf::schedules::synthesis::trade
