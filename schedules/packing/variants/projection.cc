#include "schedules/packing/variants/projection.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace ttf::schedules::packing::variants {

Assignment Projection::of(const Assignment& assignment) const {
  Assignment own;
  for (const std::size_t signal : whole) own.push_back(assignment[signal]);
  return own;
}

Order of_variant(const Instance& instance, const Order& order, int variant) {
  Order own;
  std::copy_if(order.begin(), order.end(), std::back_inserter(own),
               [&](std::size_t signal) { return (instance.signals[signal].variants >> variant & 1) != 0; });
  return own;
}

Instance one_vehicle(Instance instance) {
  instance.variants.clear();
  for (Signal& signal : instance.signals) signal.variants = kAllVariants;
  return instance;
}

Projection projection(const Instance& instance, int variant) {
  Order all(instance.signals.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Projection projected{one_vehicle(instance), of_variant(instance, all, variant)};
  std::vector<Signal> own;
  for (const std::size_t signal : projected.whole) own.push_back(projected.instance.signals[signal]);
  projected.instance.signals = std::move(own);
  return projected;
}

}  // namespace ttf::schedules::packing::variants
