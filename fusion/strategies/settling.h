// Until when a sensor has nothing more to deliver: the promise of a schedule, as a step function of time.
//
//   settled(now)
//     |                      o-----------  measured(1)
//     |          o-----------              measured(0)
//     |----------
//     +----------+-----------+-----------> now
//              at(0)       at(1)
//
// Before at(1) a list of measured(1) may still come; from at(1) on, it and all older ones have come or never
// will. The steps repeat with the schedule.
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
  // One round of steps: at least one, strictly increasing in both, the last less than a round after the
  // first.
  Settling(std::vector<Step> steps, Duration round);
  // Where no schedule says more than that nothing takes longer than `worst_delay`: settled(now) = now -
  // worst.
  static Settling after(Duration worst_delay);

  GlobalTime settled(GlobalTime now) const;
  // The first instant at which settled() is `measured` or later.
  GlobalTime settled_from(GlobalTime measured) const;

 private:
  std::vector<Step> steps_;
  Duration round_;
};

}  // namespace ttf::fusion::strategies
