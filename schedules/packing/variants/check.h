// Checks a schedule of variants: the vehicle of each variant, by check.h. A signal has the same place in all its
// variants, as an assignment has one place a signal.
#pragma once

#include <vector>

#include "schedules/packing/check.h"

namespace ttf::schedules::packing::variants {

// Returns the broken rules in the order of signals, each signal with that of its first variant that breaks one. The
// text ends with the variant's name. Without variants, these are violations() of check.h.
std::vector<Violation> variant_violations(const Instance& instance, const Assignment& assignment);

}  // namespace ttf::schedules::packing::variants
