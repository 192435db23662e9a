// The second stage: bins of several nodes in the columns of the table. Bins that no variant uses both of may have one
// column, and then its owner differs between variants.
//
// The graph of bins that share a variant is coloured (Dvorak, Hanzalek, IEEE Transactions on Vehicular Technology,
// 2018), and greedily. The next bin is the one that the fewest opened columns can take (Brelaz, "New methods to color
// the vertices of a graph", Communications of the ACM 22, 1979); among equals, the one with the most variants. It takes
// the column that has the fewest variants left.
#pragma once

#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

struct Columns {
  std::vector<int> of_bin;  // the column of each bin
  int count = 0;            // with those that stand
};

// `standing` has the variants in use of the columns that stand, `bins` those of the bins to be added.
Columns columns_of(const std::vector<VariantSet>& standing, const std::vector<VariantSet>& bins);

}  // namespace ttf::schedules::packing::variants
