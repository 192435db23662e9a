#include "schedules/packing/variants/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "schedules/packing/orders.h"

namespace ttf::schedules::packing::variants {
namespace {

struct Attempt {
  Order order;
  Fit fit = Fit::kLowestCycle;
  std::string how;
};

// The rule of an order gives way to the number of variants: not at all, among signals of one period, or altogether.
enum class Widest { kNo, kOfPeriod, kFirst };
constexpr std::pair<Widest, const char*> kWidest[] = {
    {Widest::kFirst, "variants, "}, {Widest::kOfPeriod, "period, variants, "}, {Widest::kNo, ""}};

Order widest_first(const Instance& instance, Order order, Widest widest) {
  const auto rank = [&](std::size_t index) {
    const Signal& signal = instance.signals[index];
    return std::pair(widest == Widest::kOfPeriod ? signal.repetition : 0,
                     -std::popcount(signal.variants & instance.all_variants()));
  };
  if (widest != Widest::kNo)
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

std::vector<Attempt> attempts(const Instance& instance, const Order& signals) {
  std::vector<Attempt> all;
  for (const bool by_node : {false, true}) {
    if (by_node && !instance.shared_slots) continue;
    for (const auto& [widest, name] : kWidest) {
      if (by_node && widest != Widest::kNo) continue;  // nodes would come last among the keys
      for (const OrderRule& rule : order_rules())
        for (const Fit fit : {Fit::kLowestCycle, Fit::kLowestBit})
          all.push_back({widest_first(instance, ordered(instance, signals, rule, by_node), widest), fit,
                         fmt::format("{}{}{}, by lowest {}", name, by_node ? "node, " : "", rule.name,
                                     fit == Fit::kLowestBit ? "bit" : "cycle")});
    }
  }
  return all;
}

bool no_more(const std::vector<int>& bins, const std::vector<int>& than) {
  return std::equal(bins.begin(), bins.end(), than.begin(), std::less_equal<>());
}

// The variants of each bin, in no order that matters.
std::multiset<VariantSet> bin_variants(const Candidate& candidate) {
  std::multiset<VariantSet> sets;
  for (const Bin& bin : candidate.packed.bins) sets.insert(bin.used_variants());
  return sets;
}

// Keeps the candidate unless another one has no more bins in any variant and fewer in some, or bins of the same
// variants. Removes those that are worse than it.
void keep(Candidate candidate, std::vector<Candidate>& kept) {
  const auto worse = [](const Candidate& a, const Candidate& b) { return a.bins != b.bins && no_more(b.bins, a.bins); };
  for (const Candidate& other : kept)
    if (worse(candidate, other) || bin_variants(candidate) == bin_variants(other)) return;
  std::erase_if(kept, [&](const Candidate& other) { return worse(other, candidate); });
  kept.push_back(std::move(candidate));
}

std::pair<int, std::size_t> cost(const Candidate& candidate) {
  return {std::accumulate(candidate.bins.begin(), candidate.bins.end(), 0), candidate.packed.bins.size()};
}

}  // namespace

std::vector<Candidate> candidates(const Instance& instance, const Order& signals, const Packed& fixed,
                                  const std::vector<int>& bounds, const Effort& effort, int part) {
  std::vector<Candidate> kept;
  const std::vector<Attempt> all = attempts(instance, signals);
  const Attempt* best = nullptr;
  std::pair<int, std::size_t> least;
  for (const Attempt& attempt : all) {
    Candidate candidate{fixed, {}, attempt.how};
    first_fit(instance, attempt.order, attempt.fit, candidate.packed);
    candidate.bins = bins_by_variant(instance, candidate.packed.bins);
    if (const auto own = cost(candidate); best == nullptr || own < least) {
      best = &attempt;
      least = own;
    }
    keep(std::move(candidate), kept);
  }
  const auto ideal = [&](const Candidate& candidate) { return no_more(candidate.bins, bounds); };
  if (std::none_of(kept.begin(), kept.end(), ideal)) {
    Candidate candidate{improved(instance, best->order, best->fit, fixed, bounds, effort, part), {}, {}};
    candidate.bins = bins_by_variant(instance, candidate.packed.bins);
    candidate.how = best->how + ", improved";
    keep(std::move(candidate), kept);
  }
  std::stable_sort(kept.begin(), kept.end(), [](const Candidate& a, const Candidate& b) { return cost(a) < cost(b); });
  return kept;
}

}  // namespace ttf::schedules::packing::variants
