#include "schedules/packing/packer.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "schedules/packing/lower_bound.h"
#include "schedules/packing/orders.h"

namespace ttf::schedules::packing {
namespace {

struct Attempt {
  Order order;
  Fit fit = Fit::kLowestCycle;
  std::string how;
};

std::vector<Attempt> attempts(const Instance& instance, const Order& signals) {
  std::vector<Attempt> all;
  for (const bool by_node : {false, true}) {
    if (by_node && !instance.shared_slots) continue;
    for (const OrderRule& rule : order_rules())
      for (const Fit fit : {Fit::kLowestCycle, Fit::kLowestBit})
        all.push_back({ordered(instance, signals, rule, by_node), fit,
                       fmt::format("{}{}, by lowest {}", by_node ? "node, " : "", rule.name,
                                   fit == Fit::kLowestBit ? "bit" : "cycle")});
  }
  return all;
}

struct Tried {
  Packed packed;
  std::string how;
};

// Returns the first attempt with the fewest bins. Those after one that reaches the bound are not needed.
Tried best_attempt(const Instance& instance, const Order& added, const Packed& fixed, int bound, const Effort& effort,
                   int part) {
  Tried best;
  const Attempt* found = nullptr;
  const std::vector<Attempt> all = attempts(instance, added);
  for (const Attempt& attempt : all) {
    Packed packed = fixed;
    first_fit(instance, attempt.order, attempt.fit, packed);
    if (found != nullptr && packed.bins.size() >= best.packed.bins.size()) continue;
    best = {std::move(packed), attempt.how};
    found = &attempt;
    if (static_cast<int>(best.packed.bins.size()) <= bound) return best;
  }
  Packed packed = improved(instance, found->order, found->fit, fixed, {bound}, effort, part);
  if (packed.bins.size() < best.packed.bins.size()) best = {std::move(packed), best.how + ", improved"};
  return best;
}

// The places that stand among a part's signals, with bins numbered for the part alone.
struct Standing {
  Places places;
  std::vector<int> bins;  // the number of each in the whole table
};

Standing standing_of(const Instance& instance, const Order& signals, const Places& fixed) {
  std::map<int, int> own;  // whole table's number -> part's
  for (const std::size_t signal : signals)
    if (signal < fixed.size() && fixed[signal]) own.emplace(fixed[signal]->bin, 0);
  Standing standing{Places(instance.signals.size()), {}};
  for (auto& [whole, part] : own) {
    part = static_cast<int>(standing.bins.size());
    standing.bins.push_back(whole);
  }
  for (const std::size_t signal : signals)
    if (signal < fixed.size() && fixed[signal]) {
      standing.places[signal] = fixed[signal];
      standing.places[signal]->bin = own.at(fixed[signal]->bin);
    }
  return standing;
}

// Adds a part to the solution.
void pack_part(const Instance& instance, const Order& signals, const Places& fixed, const Effort& effort,
               std::vector<int> nodes, Solution& solution) {
  Standing standing = standing_of(instance, signals, fixed);
  Order added;
  std::copy_if(signals.begin(), signals.end(), std::back_inserter(added),
               [&](std::size_t signal) { return !standing.places[signal]; });
  Part part{std::move(nodes), signals.size(), load(instance, signals), 0, 0, 0, {}};
  part.bound = std::max(least_bins(instance, signals), static_cast<int>(standing.bins.size()));
  const Tried best = best_attempt(instance, added, with_fixed(instance, standing.places), part.bound, effort,
                                  static_cast<int>(solution.parts.size()));
  part.bins = static_cast<int>(best.packed.bins.size());
  part.how = best.how;
  for (const Bin& bin : best.packed.bins) part.used_bits += bin.used_bits();
  while (static_cast<int>(standing.bins.size()) < part.bins) standing.bins.push_back(solution.bins++);
  for (const std::size_t signal : signals) {
    solution.places[signal] = best.packed.places[signal];
    solution.places[signal]->bin = standing.bins[static_cast<std::size_t>(solution.places[signal]->bin)];
  }
  solution.parts.push_back(std::move(part));
}

}  // namespace

int Solution::bound() const {
  return std::accumulate(parts.begin(), parts.end(), 0, [](int sum, const Part& part) { return sum + part.bound; });
}

bool Solution::proven() const {
  return std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.proven(); });
}

Solution pack(const Instance& instance, const Places& fixed, const Effort& effort) {
  TTF_CHECK(instance.variants.empty(), "{} variants: variants/packer.h packs them", instance.variants.size());
  Solution solution;
  solution.places.resize(instance.signals.size());
  for (const auto& place : fixed)
    if (place) solution.bins = std::max(solution.bins, place->bin + 1);
  const Order all = possible_signals(instance);
  std::vector<int> nodes(instance.nodes.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  if (instance.shared_slots) {
    pack_part(instance, all, fixed, effort, nodes, solution);
  } else {
    for (const int node : nodes) pack_part(instance, of_node(instance, all, node), fixed, effort, {node}, solution);
  }
  return solution;
}

}  // namespace ttf::schedules::packing
