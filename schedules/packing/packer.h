// Packs an instance: every order with every kind of first fit (orders.h, bin.h), then the improvement (improvement.h),
// part by part.
//
// A part is a set of signals that share bins: those of one node, or all of them where slots are shared. The bins of a
// part are compared with its bound (lower_bound.h). A part that reaches its bound is optimal, and needs no solver for a
// proof.
#pragma once

#include <string>
#include <vector>

#include "schedules/packing/improvement.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

struct Part {
  std::vector<int> nodes;
  std::size_t signals = 0;  // with a place
  double load = 0.0;        // lower_bound.h
  int bound = 0;            // the bins that any packing needs, beside those that stand
  int bins = 0;
  std::int64_t used_bits = 0;  // in all cycles
  std::string how;             // the order that was best

  bool proven() const { return bins == bound; }
};

struct Solution {
  Places places;  // none for a signal without a window, or longer than a frame
  int bins = 0;   // numbered from 0: first those of `fixed`, then new ones, part by part
  std::vector<Part> parts;

  int bound() const;
  bool proven() const;
};

// Packs an instance without variants (variants/packer.h packs those with them). Keeps the places of `fixed` (by signal;
// empty, or with an entry for each). They must have passed check.h. Their bins are numbered from 0 without a gap. With
// places that stand, a part's bound counts its standing bins, even if a packing anew needed fewer.
Solution pack(const Instance& instance, const Places& fixed = {}, const Effort& effort = {});

}  // namespace ttf::schedules::packing
