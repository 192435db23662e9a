#include "schedules/packing/variants/families.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace ttf::schedules::packing::variants {
namespace {

constexpr std::size_t kMostComparisons = 50'000'000;

Family conflicting_with(const Family& sets, VariantSet set) {
  Family found;
  std::copy_if(sets.begin(), sets.end(), std::back_inserter(found),
               [&](VariantSet other) { return other != set && (other & set) != 0; });
  return found;
}

bool share_a_variant(const Family& family) {
  VariantSet common = kAllVariants;
  for (const VariantSet set : family) common &= set;
  return common != 0;
}

class CliqueSearch {
 public:
  explicit CliqueSearch(int most) : most_(most) {}

  // Finds the maximal families of `chosen`, some of `open` and none of `done`, which all conflict with `chosen`.
  void search(const Family& chosen, Family open, Family done) {
    comparisons_ += (open.size() + done.size()) * open.size();  // those of the pivot
    if (comparisons_ > kMostComparisons || static_cast<int>(found_.size()) >= most_) return;
    if (open.empty() && done.empty() && !share_a_variant(chosen)) {
      found_.push_back(chosen);
      std::sort(found_.back().begin(), found_.back().end());
    }
    const Family tried = without_neighbours_of_pivot(open, done);
    for (const VariantSet set : tried) {
      Family next = chosen;
      next.push_back(set);
      search(next, conflicting_with(open, set), conflicting_with(done, set));
      open.erase(std::find(open.begin(), open.end(), set));
      done.push_back(set);
    }
  }

  std::vector<Family> found_;

 private:
  // The pivot is a set that conflicts with the most open ones. A maximal family has it, or a set that does not.
  static Family without_neighbours_of_pivot(const Family& open, const Family& done) {
    Family best;
    VariantSet pivot = 0;
    for (const Family* sets : {&open, &done})
      for (const VariantSet set : *sets)
        if (Family neighbours = conflicting_with(open, set); pivot == 0 || neighbours.size() > best.size()) {
          best = std::move(neighbours);
          pivot = set;
        }
    Family tried;
    std::copy_if(open.begin(), open.end(), std::back_inserter(tried),
                 [&](VariantSet set) { return std::find(best.begin(), best.end(), set) == best.end(); });
    return tried;
  }

  int most_;
  std::size_t comparisons_ = 0;
};

}  // namespace

std::vector<VariantSet> sets_of(const Instance& instance, const Order& signals) {
  std::set<VariantSet> sets;
  for (const std::size_t signal : signals) sets.insert(instance.signals[signal].variants & instance.all_variants());
  return {sets.begin(), sets.end()};
}

std::vector<Family> families(const Instance& instance, const Order& signals, int most) {
  const Family sets = sets_of(instance, signals);
  std::vector<Family> all;
  for (int variant = 0; variant < instance.variant_count(); ++variant) {
    Family& own = all.emplace_back();
    std::copy_if(sets.begin(), sets.end(), std::back_inserter(own),
                 [&](VariantSet set) { return (set >> variant & 1) != 0; });
  }
  // Sets that conflict with all others are in each maximal family.
  Family always, others;
  for (const VariantSet set : sets)
    (conflicting_with(sets, set).size() + 1 == sets.size() ? always : others).push_back(set);
  CliqueSearch search(most);
  search.search(always, others, {});
  std::move(search.found_.begin(), search.found_.end(), std::back_inserter(all));
  return all;
}

Order of_family(const Instance& instance, const Order& signals, const Family& family) {
  Order own;
  std::copy_if(signals.begin(), signals.end(), std::back_inserter(own), [&](std::size_t signal) {
    return std::binary_search(family.begin(), family.end(),
                              instance.signals[signal].variants & instance.all_variants());
  });
  return own;
}

}  // namespace ttf::schedules::packing::variants
