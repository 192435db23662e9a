#include "schedules/packing/variants/columns.h"

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

namespace ttf::schedules::packing::variants {
namespace {

class Colouring {
 public:
  explicit Colouring(const std::vector<VariantSet>& standing) : used_(standing) {}

  // Returns how many opened columns can take a bin with these variants.
  std::ptrdiff_t choices(VariantSet variants) const {
    return std::count_if(used_.begin(), used_.end(), [&](VariantSet used) { return (used & variants) == 0; });
  }

  int take(VariantSet variants) {
    auto best = used_.end();
    for (auto column = used_.begin(); column != used_.end(); ++column)
      if ((*column & variants) == 0 && (best == used_.end() || std::popcount(*column) > std::popcount(*best)))
        best = column;
    if (best == used_.end()) best = used_.insert(used_.end(), 0);
    *best |= variants;
    return static_cast<int>(best - used_.begin());
  }

  int count() const { return static_cast<int>(used_.size()); }

 private:
  std::vector<VariantSet> used_;
};

}  // namespace

Columns columns_of(const std::vector<VariantSet>& standing, const std::vector<VariantSet>& bins) {
  std::map<VariantSet, std::vector<std::size_t>> of_set;  // the bins that are left, the last one first
  for (std::size_t bin = bins.size(); bin-- > 0;) of_set[bins[bin]].push_back(bin);
  Columns columns{std::vector<int>(bins.size()), 0};
  Colouring colouring(standing);
  while (!of_set.empty()) {
    const auto rank = [&](const auto& entry) {
      return std::tuple(colouring.choices(entry.first), -std::popcount(entry.first), entry.second.back());
    };
    const auto next =
        std::min_element(of_set.begin(), of_set.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    columns.of_bin[next->second.back()] = colouring.take(next->first);
    next->second.pop_back();
    if (next->second.empty()) of_set.erase(next);
  }
  columns.count = colouring.count();
  return columns;
}

}  // namespace ttf::schedules::packing::variants
