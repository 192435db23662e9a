#include "tests/schedules/packing/exhaustive.h"

#include <cstdint>
#include <vector>

namespace ttf::schedules::packing {
namespace {

// The bin of one variant is a word: bit `offset` of cycle c is bit 8 c + offset. Its owners, by cycle, are -1 or a
// node.
struct TinyBin {
  std::uint64_t used = 0;
  std::vector<int> owner = std::vector<int>(8, -1);
};
using TinyBins = std::vector<TinyBin>;  // one bin, by variant

bool owners_allow(const Instance& instance, const TinyBin& bin, const Signal& signal, int first) {
  for (int c = 0; c < instance.cycles; ++c) {
    const bool counts = !instance.shared_slots || c % signal.repetition == first;
    const int owner = bin.owner[static_cast<std::size_t>(c)];
    if (counts && owner != -1 && owner != signal.node) return false;
  }
  return true;
}

bool fits(const Instance& instance, std::vector<TinyBins>& bins, std::size_t index, std::size_t most) {
  if (index == instance.signals.size()) return true;
  const Signal& signal = instance.signals[index];
  std::vector<std::size_t> variants;
  for (std::size_t v = 0; v < static_cast<std::size_t>(instance.variant_count()); ++v)
    if ((signal.variants >> v & 1) != 0) variants.push_back(v);
  for (std::size_t b = 0; b < most; ++b) {
    if (b > bins.size()) break;  // one empty bin is like the other
    if (b == bins.size()) bins.emplace_back(static_cast<std::size_t>(instance.variant_count()));
    for (int first = signal.window.earliest; first <= signal.window.latest; ++first) {
      bool allowed = true;
      for (const std::size_t v : variants) allowed = allowed && owners_allow(instance, bins[b][v], signal, first);
      for (int offset = 0; allowed && offset + signal.bits <= instance.payload_bits; ++offset) {
        std::uint64_t wanted = 0, used = 0;
        for (int c = first; c < instance.cycles; c += signal.repetition)
          wanted |= ((std::uint64_t{1} << signal.bits) - 1) << (8 * c + offset);
        for (const std::size_t v : variants) used |= bins[b][v].used;
        if ((used & wanted) != 0) continue;
        const TinyBins before = bins[b];
        for (const std::size_t v : variants) {
          bins[b][v].used |= wanted;
          for (int c = first; c < instance.cycles; c += signal.repetition)
            bins[b][v].owner[static_cast<std::size_t>(c)] = signal.node;
        }
        const std::size_t open = bins.size();
        if (fits(instance, bins, index + 1, most)) return true;
        bins.resize(open);
        bins[b] = before;
      }
    }
  }
  return false;
}

}  // namespace

int fewest_bins(const Instance& instance) {
  for (std::size_t most = 0;; ++most) {
    std::vector<TinyBins> bins;
    if (fits(instance, bins, 0, most)) return static_cast<int>(most);
  }
}

}  // namespace ttf::schedules::packing
