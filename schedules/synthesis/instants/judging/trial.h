// A candidate, and how well its instants meet the objectives so far.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants::judging {

struct Trial {
  Candidate candidate;
  Limits limits;
  std::optional<Placed> placed;
  bool out = false;
  // Behind an objective that a judge counts: these beginnings stand, so that its value does not change.
  struct Pin {
    std::size_t activity = 0;
    Ticks at = 0;
  };
  std::vector<Pin> pins;
};

// Returns the trial's problem with its pins; none where parameters leave their range.
std::optional<Read> read_of(const plan::Plan& plan, const Trial& trial);

// Keeps all ages of the placement, and the beginnings of the first and the last activities of chains.
void pin(const Problem& problem, Trial& trial);

}  // namespace ttf::schedules::synthesis::instants::judging
