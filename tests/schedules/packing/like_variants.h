// Draws signals of several variants: those of like_instance.h. Some are in all variants. The others are in a drawn set.
#pragma once

#include "tests/schedules/packing/like_instance.h"

namespace ttf::schedules::packing {

// `common` is the percentage of signals that all variants have.
inline Instance like_variants(Instance instance, int variants, std::uint64_t seed, int common = 50) {
  RandomStream random({seed, 3, Purpose::kTest});
  for (int variant = 0; variant < variants; ++variant) instance.variants.push_back("v" + std::to_string(variant));
  for (Signal& signal : instance.signals) {
    signal.variants = instance.all_variants();
    if (random.integer(1, 100) > common)
      signal.variants = static_cast<VariantSet>(random.integer(1, static_cast<std::int64_t>(instance.all_variants())));
  }
  return instance;
}

}  // namespace ttf::schedules::packing
