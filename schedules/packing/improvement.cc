#include "schedules/packing/improvement.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/random.h"

namespace ttf::schedules::packing {
namespace {

// A packing, and where it is above its bounds.
struct Judged {
  Packed packed;
  std::int64_t bins = 0;       // the sum over variants
  std::int64_t last_bits = 0;  // used in the last bin
  std::set<int> last;          // the last bins of the variants above their bounds

  bool worse_than(const Judged& other) const {
    return std::pair(bins, last_bits) > std::pair(other.bins, other.last_bits);
  }
};

Judged judged(const Instance& instance, Packed packed, const std::vector<int>& bounds) {
  Judged judged{std::move(packed), 0, 0, {}};
  const std::vector<Bin>& bins = judged.packed.bins;
  const std::vector<int> by_variant = bins_by_variant(instance, bins);
  for (std::size_t variant = 0; variant < by_variant.size(); ++variant) {
    judged.bins += by_variant[variant];
    if (by_variant[variant] <= bounds[variant]) continue;
    const auto is_used = [&](const Bin& bin) { return (bin.used_variants() >> variant & 1) != 0; };
    judged.last.insert(static_cast<int>(std::find_if(bins.rbegin(), bins.rend(), is_used).base() - bins.begin()) - 1);
  }
  judged.last_bits = bins.empty() ? 0 : bins.back().used_bits();
  return judged;
}

// Moves each signal of the last bins ahead with a probability of one half, by a random part of its way to the front.
Order squeaked(const Order& order, const Judged& judged, RandomStream& random) {
  Order next = order;
  for (std::size_t at = 0; at < next.size(); ++at) {
    if (!judged.last.contains(judged.packed.places[next[at]]->bin) || random.uniform() < 0.5) continue;
    const auto to = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(at)));
    std::rotate(next.begin() + static_cast<std::ptrdiff_t>(to), next.begin() + static_cast<std::ptrdiff_t>(at),
                next.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  }
  return next;
}

}  // namespace

std::vector<int> bins_by_variant(const Instance& instance, const std::vector<Bin>& bins) {
  std::vector<int> counts(static_cast<std::size_t>(instance.variant_count()));
  for (const Bin& bin : bins)
    each_variant(bin.used_variants(), [&](int variant) { ++counts[static_cast<std::size_t>(variant)]; });
  return counts;
}

Packed improved(const Instance& instance, Order order, Fit fit, const Packed& fixed, const std::vector<int>& bounds,
                const Effort& effort, int part) {
  RandomStream random({effort.seed, 0, Purpose::kPacking, static_cast<std::uint16_t>(part)});
  const auto packed = [&](const Order& next) {
    Packed anew = fixed;
    first_fit(instance, next, fit, anew);
    return judged(instance, std::move(anew), bounds);
  };
  Judged best = packed(order);
  for (int step = 0; step < effort.steps && !best.last.empty(); ++step) {
    Order next = squeaked(order, best, random);
    Judged tried = packed(next);
    if (tried.worse_than(best)) continue;
    best = std::move(tried);
    order = std::move(next);
  }
  return std::move(best.packed);
}

}  // namespace ttf::schedules::packing
