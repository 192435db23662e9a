#include "schedules/packing/variants/pieces.h"

#include <algorithm>

namespace ttf::schedules::packing::variants {
namespace {

// Adds a piece, and joins those that it has a variant in common with.
void join(std::vector<Piece>& pieces, const Piece& added) {
  Piece joined = added;
  std::erase_if(pieces, [&](const Piece& piece) {
    if ((piece.variants & added.variants) == 0) return false;
    joined = {joined.variants | piece.variants, joined.stands || piece.stands};
    return true;
  });
  pieces.push_back(joined);
}

}  // namespace

std::vector<std::vector<Piece>> pieces_of(const Instance& instance, const Places& places, const Places& standing) {
  std::vector<std::vector<Piece>> pieces;
  for (std::size_t signal = 0; signal < places.size(); ++signal) {
    if (!places[signal]) continue;
    const auto bin = static_cast<std::size_t>(places[signal]->bin);
    if (bin >= pieces.size()) pieces.resize(bin + 1);
    join(pieces[bin], {instance.signals[signal].variants & instance.all_variants(),
                       signal < standing.size() && standing[signal].has_value()});
  }
  for (std::vector<Piece>& of_bin : pieces)
    std::sort(of_bin.begin(), of_bin.end(), [](const Piece& a, const Piece& b) { return a.variants < b.variants; });
  return pieces;
}

std::vector<std::vector<Piece>> whole_bins(std::vector<std::vector<Piece>> pieces) {
  for (std::vector<Piece>& of_bin : pieces) {
    Piece whole;
    for (const Piece& piece : of_bin) whole = {whole.variants | piece.variants, whole.stands || piece.stands};
    of_bin = {whole};
  }
  return pieces;
}

}  // namespace ttf::schedules::packing::variants
