// Meetings and prospects (judge.h) of a plan's problem.
#pragma once

#include <vector>

#include "core/time.h"
#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants::judging {

// Chains of one sensor to one task count once. `tick_ps`: the macrotick.
std::vector<ChainEnd> chain_ends(const plan::Plan& plan, const Problem& problem, std::int64_t tick_ps,
                                 const std::vector<Ticks>& offsets);

// Within the limits. The reading must outlive what is returned.
std::vector<Prospect> prospects(const plan::Plan& plan, const Reading& reading, const Limits& limits,
                                std::int64_t tick_ps);

}  // namespace ttf::schedules::synthesis::instants::judging
