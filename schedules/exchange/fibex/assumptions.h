// What a FIBEX file leaves open and a cluster file must state. Where the specification ties a parameter to
// others it follows from them; the rest are this program's defaults (schedules/model/flexray_parameters.h).
// Everything set here is for the reader of the cluster file to confirm.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "schedules/exchange/fibex/file.h"

namespace ttf::schedules::exchange::fibex {

// Completes the global parameters; what cannot be assumed (the layout of the cycle) goes to `wrong`. Paths of
// the assumed ones ("flexray.gdNIT") go to `assumed`.
void assume_global(FibexFile& file, const std::string& name, std::set<std::string, std::less<>>& assumed,
                   Findings& wrong);

// Completes a node's parameters; `first_slot` is the first static slot it owns, 0 for none.
model::NodeParameters assume_local(const FibexEcu& ecu, const model::GlobalParameters& global, int first_slot,
                                   std::set<std::string, std::less<>>& assumed);

}  // namespace ttf::schedules::exchange::fibex
