// The vehicle of one variant, as an instance without variants.
#pragma once

#include "schedules/packing/check.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

// `signals` of it are those of the variant, in the order of the whole instance; their indices there are `whole`.
struct Projection {
  Instance instance;
  Order whole;

  // Returns the places of the projected signals.
  Assignment of(const Assignment& assignment) const;
};

Projection projection(const Instance& instance, int variant);

// Returns the signals of the order that the variant has.
Order of_variant(const Instance& instance, const Order& order, int variant);

// Returns one vehicle that has all signals: what a schedule without variants packs.
Instance one_vehicle(Instance instance);

}  // namespace ttf::schedules::packing::variants
