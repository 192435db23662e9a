// The pieces of a bin: signals that share variants, directly or through others. Two pieces have no variant in common,
// so each may have a column of its own.
#pragma once

#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

struct Piece {
  VariantSet variants = 0;
  bool stands = false;  // some signal of it stands: the piece cannot leave its column
};

// By bin, its pieces by ascending variants; of `places`, those that are also in `standing` stand.
std::vector<std::vector<Piece>> pieces_of(const Instance& instance, const Places& places, const Places& standing);

// The same without a division: each bin is one piece.
std::vector<std::vector<Piece>> whole_bins(std::vector<std::vector<Piece>> pieces);

}  // namespace ttf::schedules::packing::variants
