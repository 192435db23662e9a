// The instant up to which a sensor's measurements are settled, as the schedule says: a step function of time.
//
//   settled(now)
//     |                      o-----------  measured(1)
//     |          o-----------              measured(0)
//     |----------
//     +----------+-----------+-----------> now
//              at(0)       at(1)
//
// Before at(1) a list of measured(1) may still come. From at(1) on, that list and all older ones have arrived
// or never will. The steps repeat with the schedule.
#pragma once

#include <vector>

#include "core/time.h"

namespace ttf::fusion::strategies {

class Settling {
 public:
  // From the instant `at` on, all lists stamped `measured` or earlier have arrived or never will.
  struct Step {
    GlobalTime at{};
    GlobalTime measured{};
  };
  // Takes one round of steps: at least one, strictly increasing in both fields, the last less than a round
  // after the first.
  Settling(std::vector<Step> steps, Duration round);
  // Returns the settling of a schedule that only bounds the delay: settled(now) = now - worst_delay.
  static Settling after(Duration worst_delay);

  GlobalTime settled(GlobalTime now) const;
  // Returns the first instant at which settled() is `measured` or later.
  GlobalTime settled_from(GlobalTime measured) const;

 private:
  std::vector<Step> steps_;
  Duration round_;
};

}  // namespace ttf::fusion::strategies
