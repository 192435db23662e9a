#include "schedules/packing/variants/use.h"

#include "schedules/packing/lower_bound.h"
#include "schedules/packing/variants/lower_bound.h"
#include "schedules/packing/variants/projection.h"

namespace ttf::schedules::packing::variants {

std::vector<VariantUse> uses(const Instance& instance, const Places& places) {
  Order placed;
  for (std::size_t signal = 0; signal < places.size(); ++signal)
    if (places[signal]) placed.push_back(signal);
  const std::vector<int> bounds = least_slots_by_variant(instance, placed);
  std::vector<VariantUse> uses;
  for (int variant = 0; variant < instance.variant_count(); ++variant) {
    const Order own = of_variant(instance, placed, variant);
    VariantUse use{own.size(), load(instance, own), bounds[static_cast<std::size_t>(variant)], {}};
    for (const std::size_t signal : own) use.bins.insert(places[signal]->bin);
    uses.push_back(std::move(use));
  }
  return uses;
}

}  // namespace ttf::schedules::packing::variants
