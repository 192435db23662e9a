// Families of signals that conflict in pairs: any two of them share a variant.
//
// The signals of one variant are such a family. There are others: signals of the variants 1 and 2, of 2 and 3, and of
// 1 and 3 conflict in pairs, though no variant has all three. Whether two signals conflict depends on their sets of
// variants alone, so a family is a clique in the graph of these sets (Bron, Kerbosch, "Finding all cliques of an
// undirected graph", Communications of the ACM 16, 1973, with the pivot of Tomita, Tanaka, Takahashi, 2006).
#pragma once

#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

// Sets of variants, ascending, any two of which intersect.
using Family = std::vector<VariantSet>;

// Returns the distinct sets of variants of these signals, ascending.
std::vector<VariantSet> sets_of(const Instance& instance, const Order& signals);

// Returns the family of each variant, and the maximal families in which no variant has all: the first `most` of them
// that a search of limited length finds.
std::vector<Family> families(const Instance& instance, const Order& signals, int most);

// Returns the signals with a set of the family.
Order of_family(const Instance& instance, const Order& signals, const Family& family);

}  // namespace ttf::schedules::packing::variants
