#include "schedules/packing/variants/lower_bound.h"

#include <algorithm>
#include <set>

#include "schedules/packing/lower_bound.h"
#include "schedules/packing/variants/families.h"
#include "schedules/packing/variants/projection.h"

namespace ttf::schedules::packing::variants {
namespace {

constexpr int kMostFamilies = 100;

int standing_bins(const Order& signals, const Places& standing) {
  std::set<int> bins;
  for (const std::size_t signal : signals)
    if (signal < standing.size() && standing[signal]) bins.insert(standing[signal]->bin);
  return static_cast<int>(bins.size());
}

// Signals that conflict in pairs.
int least_of_family(const Instance& instance, const Order& signals, const Places& standing) {
  const auto least = [&](const Order& part) {
    return std::max(least_bins(instance, part), standing_bins(part, standing));
  };
  if (instance.shared_slots) return least(signals);
  int sum = 0;
  for (int node = 0; node < static_cast<int>(instance.nodes.size()); ++node)
    sum += least(of_node(instance, signals, node));
  return sum;
}

}  // namespace

int least_slots(const Instance& instance, const Order& signals, const Places& standing) {
  int most = standing_bins(signals, standing);
  for (const Family& family : families(instance, signals, kMostFamilies))
    most = std::max(most, least_of_family(instance, of_family(instance, signals, family), standing));
  return most;
}

std::vector<int> least_slots_by_variant(const Instance& instance, const Order& signals) {
  std::vector<int> least;
  for (int variant = 0; variant < instance.variant_count(); ++variant)
    least.push_back(least_of_family(instance, of_variant(instance, signals, variant), {}));
  return least;
}

}  // namespace ttf::schedules::packing::variants
