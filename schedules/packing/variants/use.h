// The use that each variant's vehicle makes of a schedule.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

struct VariantUse {
  std::size_t signals = 0;  // with a place
  double load = 0.0;        // packing/lower_bound.h
  int bound = 0;            // the bins that its vehicle alone needs
  std::set<int> bins;       // in use
};

// Returns the use of each variant.
std::vector<VariantUse> uses(const Instance& instance, const Places& places);

}  // namespace ttf::schedules::packing::variants
