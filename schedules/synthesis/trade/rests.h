// Why data rests on a chain's way in a schedule that was found (binding.h has the causes).
#pragma once

#include <string>
#include <vector>

#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::trade {

using instants::Read;
using instants::Reading;

struct Rest {
  std::string cause;
  Ticks time = 0;
};

// Returns the beginnings along a chain, in one count of ticks, for the measurement that grows oldest.
std::vector<Ticks> oldest_way(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets);

// Returns the rests between the i-th activity of a chain and the next one; `at` are the beginnings along the chain. They add up to
// the time between the two, less the first one's duration and the gap.
std::vector<Rest> rests(const Reading& reading, const std::vector<Ticks>& offsets, std::size_t chain, std::size_t i,
                        const std::vector<Ticks>& at);

}  // namespace ttf::schedules::synthesis::trade
