#include "schedules/synthesis/packing/improvement.h"

#include <algorithm>
#include <utility>

#include "core/random.h"

namespace ttf::schedules::synthesis::packing {
namespace {

std::pair<std::size_t, std::int64_t> badness(const Packed& packed) {
  return {packed.bins.size(), packed.bins.empty() ? 0 : packed.bins.back().used_bits()};
}

// Moves each signal of the last bin ahead with a probability of one half, by a random part of its way to the front.
Order squeaked(const Order& order, const Packed& packed, RandomStream& random) {
  Order next = order;
  const int last = static_cast<int>(packed.bins.size()) - 1;
  for (std::size_t at = 0; at < next.size(); ++at) {
    if (packed.places[next[at]]->bin != last || random.uniform() < 0.5) continue;
    const auto to = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(at)));
    std::rotate(next.begin() + static_cast<std::ptrdiff_t>(to), next.begin() + static_cast<std::ptrdiff_t>(at),
                next.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  }
  return next;
}

}  // namespace

Packed improved(const Instance& instance, Order order, Fit fit, const Packed& fixed, int bound, const Effort& effort,
                int part) {
  RandomStream random({effort.seed, 0, Purpose::kPacking, static_cast<std::uint16_t>(part)});
  Packed best = fixed;
  first_fit(instance, order, fit, best);
  for (int step = 0; step<effort.steps&& static_cast<int>(best.bins.size())> bound; ++step) {
    Order next = squeaked(order, best, random);
    Packed packed = fixed;
    first_fit(instance, next, fit, packed);
    if (badness(packed) > badness(best)) continue;
    best = std::move(packed);
    order = std::move(next);
  }
  return best;
}

}  // namespace ttf::schedules::synthesis::packing
