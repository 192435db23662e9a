// Assumes parameters that a FIBEX file omits and a cluster file needs. Parameters tied to others by the
// specification follow from them; the rest are this program's defaults (schedules/model/flexray_parameters.h).
// The author of the cluster file must confirm all assumed values.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "schedules/exchange/fibex/file.h"

namespace ttf::schedules::exchange::fibex {

// Completes the global parameters. Parameters that cannot be assumed (the layout of the cycle) are added to
// `wrong`, paths of assumed ones ("flexray.gdNIT") to `assumed`.
void assume_global(FibexFile& file, const std::string& name, std::set<std::string, std::less<>>& assumed,
                   Findings& wrong);

// Completes a node's parameters; `first_slot` is its first static slot, or 0.
model::NodeParameters assume_local(const FibexEcu& ecu, const model::GlobalParameters& global, int first_slot,
                                   std::set<std::string, std::less<>>& assumed);

}  // namespace ttf::schedules::exchange::fibex
