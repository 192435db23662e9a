// The world of another simulator in place of a scenario's objects: `--truth`.
#pragma once

#include <memory>
#include <string>

#include "recording/osi/truth_trace.h"
#include "sim/drives/scenario.h"

namespace ttf::sim::drives {

// Makes the trace the scenario's world. The drive ends with the trace, or before. The scenario's own objects, its
// vehicle's motion and its reference are not used; sensors, tracker, clusters and faults are. Throws InputError if the
// trace ends before the judged part begins, or is shorter than the shortest drive.
void take_truth(Scenario& scenario, std::shared_ptr<const recording::osi::TruthTrace> trace);

// Returns a sentence about the trace and its use. Precondition: the scenario has one.
std::string truth_text(const Scenario& scenario);

// Returns the scenario's description. With a trace, returns a sentence about the trace and the scenario.
std::string subject_of(const Scenario& scenario);

inline constexpr Duration kShortestDrive = Duration::milliseconds(100);

}  // namespace ttf::sim::drives
