// The columns of places that stand, and their owners in each variant.
#pragma once

#include <map>
#include <vector>

#include "schedules/packing/first_fit.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

class StandingColumns {
 public:
  // `fixed` is empty, or has an entry for each signal. Both must outlive the object.
  StandingColumns(const Instance& instance, const Places& fixed);

  int count() const { return count_; }

  // Returns the places of these signals that stand, in bins of their own, and adds the columns of the bins to
  // `columns`. The signals are those of the node; where slots are shared, they are all signals and the node is 0. A bin
  // is blocked in the variants of other owners. The owner of the lowest number also has the variants without an owner.
  Packed bins_of(const Order& signals, int node, std::vector<int>& columns) const;

 private:
  using Owners = std::map<int, VariantSet>;  // the variants of each node

  VariantSet blocked(const Owners& owners, int node) const;

  const Instance& instance_;
  const Places& fixed_;
  int count_ = 0;
  std::map<int, Owners> owned_;  // by column
};

}  // namespace ttf::schedules::packing::variants
