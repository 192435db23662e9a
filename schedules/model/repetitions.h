// How often things may happen: in every `repetition` cycles, a divisor of the cycle counter's values, so that the schedule
// repeats.
//
//   tasks, measurements   every divisor of gCycleCountMax + 1
//   frames                those among them that a controller can filter: 1, 2, 4, 8, 16, 32, 64 (FlexRay 2.1 Rev. A), and
//                         5, 10, 20, 40, 50 (3.0.1, which has gCycleCountMax = 7, 9, ..., 63)
#pragma once

#include <string>
#include <vector>

#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::model {

// Return the repetitions, the smallest first.
std::vector<int> repetitions(const GlobalParameters& flexray);
std::vector<int> frame_repetitions(const GlobalParameters& flexray);

// Returns the sentence for a repetition that is not among them: "must be one of 1, 2, 4, 8, 16, 32, 64".
std::string repetitions_text(const GlobalParameters& flexray, const std::vector<int>& among);

}  // namespace ttf::schedules::model
