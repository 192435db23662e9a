// Finds offsets of a plan's problem by placing activities backwards from the use of the data, each as late as it may be.
//
// Ages count back from the last beginning of a chain, so a later beginning of anything before it makes no age larger. The last
// task of the chains is the anchor. It is tried right behind every position of the slots before it. From there on each
// activity is placed when all that take its data are placed. Where several wait for one resource, every order is tried: a
// depth-first search with bounds (chains' longest ways to their sensors, without any wait for resources). Serial placement in
// every order finds a best solution of regular objectives (Kolisch, EJOR 90, 1996, section 2), if no activity meets a shifted
// copy of another one. A test shows it where all activities of a resource lie within one period. The answer is then exact,
// unless an order of fusions may be missing (order.h), a task may hold up the anchor, or a placement was dropped because
// the rest of the activities had no room.
//
// A search ends by a count of placements, never by a clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

struct Search {
  std::optional<Placed> best;  // least worst age, then least sum of ages
  bool exact = false;          // nothing better exists; without `best`: nothing exists
  std::int64_t steps = 0;      // placements tried
};

inline constexpr std::int64_t kMostSteps = 400'000;  // of one search

// Returns the best placement within the limits. With `any` it returns the first one.
Search place(const Reading& reading, const Limits& limits, bool any = false, std::int64_t most_steps = kMostSteps);

}  // namespace ttf::schedules::synthesis::instants
