#include "schedules/packing/first_fit.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/check.h"

namespace ttf::schedules::packing {

void first_fit(const Instance& instance, const Order& order, Fit fit, Packed& packed) {
  // Bins only fill up, so a signal need not look at those that had no room for an earlier one like it.
  using Kind = std::tuple<VariantSet, int, int, int, int, int>;
  std::map<Kind, std::size_t> begin_at;
  for (const std::size_t index : order) {
    const Signal& signal = instance.signals[index];
    TTF_CHECK(!signal.window.empty() && signal.bits <= instance.payload_bits, "signal {} has no place", signal.name);
    std::size_t& bin = begin_at[{signal.variants, signal.node, signal.repetition, signal.bits, signal.window.earliest,
                                 signal.window.latest}];
    std::optional<BitPlace> place;
    for (; !place; ++bin) {
      if (bin == packed.bins.size()) packed.bins.emplace_back(instance);
      place = packed.bins[bin].first_place(signal, fit);
      if (place) break;
    }
    place->bin = static_cast<int>(bin);
    packed.bins[bin].occupy(signal, *place);
    packed.places[index] = place;
  }
}

Packed with_fixed(const Instance& instance, const Places& fixed) {
  Packed packed{{}, fixed};
  packed.places.resize(instance.signals.size());
  for (std::size_t i = 0; i < packed.places.size(); ++i) {
    if (!packed.places[i]) continue;
    const BitPlace& place = *packed.places[i];
    while (packed.bins.size() <= static_cast<std::size_t>(place.bin)) packed.bins.emplace_back(instance);
    packed.bins[static_cast<std::size_t>(place.bin)].occupy(instance.signals[i], place);
  }
  return packed;
}

}  // namespace ttf::schedules::packing
