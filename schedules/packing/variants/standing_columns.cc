#include "schedules/packing/variants/standing_columns.h"

#include <algorithm>

namespace ttf::schedules::packing::variants {

StandingColumns::StandingColumns(const Instance& instance, const Places& fixed) : instance_(instance), fixed_(fixed) {
  for (std::size_t signal = 0; signal < fixed.size(); ++signal) {
    if (!fixed[signal]) continue;
    const Signal& of = instance.signals[signal];
    count_ = std::max(count_, fixed[signal]->bin + 1);
    owned_[fixed[signal]->bin][instance.shared_slots ? 0 : of.node] |= of.variants & instance.all_variants();
  }
}

Packed StandingColumns::bins_of(const Order& signals, int node, std::vector<int>& columns) const {
  Places places(instance_.signals.size());
  std::map<int, int> bin_of;  // by column
  for (const auto& [column, owners] : owned_)
    if (owners.contains(node)) {
      bin_of.emplace(column, static_cast<int>(columns.size()));
      columns.push_back(column);
    }
  for (const std::size_t signal : signals)
    if (signal < fixed_.size() && fixed_[signal]) {
      places[signal] = fixed_[signal];
      places[signal]->bin = bin_of.at(fixed_[signal]->bin);
    }
  Packed packed = with_fixed(instance_, places);
  for (const auto& [column, bin] : bin_of)
    packed.bins[static_cast<std::size_t>(bin)].block(blocked(owned_.at(column), node));
  return packed;
}

VariantSet StandingColumns::blocked(const Owners& owners, int node) const {
  VariantSet others = 0;
  for (const auto& [owner, variants] : owners)
    if (owner != node) others |= variants;
  return owners.begin()->first == node ? others : instance_.all_variants() & ~owners.at(node);
}

}  // namespace ttf::schedules::packing::variants
