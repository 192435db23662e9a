#include "schedules/synthesis/packing/bin.h"

#include <algorithm>
#include <bit>

#include "core/check.h"

namespace ttf::schedules::synthesis::packing {
namespace {

constexpr int kWordBits = 64;

// Returns the first bit at or after `from` that has the value, or `end`.
int next_bit(const std::uint64_t* words, int from, int end, bool value) {
  while (from < end) {
    std::uint64_t word = words[from / kWordBits];
    if (!value) word = ~word;
    word >>= from % kWordBits;
    if (word != 0) return std::min(end, from + std::countr_zero(word));
    from += kWordBits - from % kWordBits;
  }
  return end;
}

// Calls on(first, bits) for each run of free bits, until it returns true.
template <class On> void each_free_run(const std::uint64_t* words, int end, On&& on) {
  for (int from = next_bit(words, 0, end, false); from < end;) {
    const int past = next_bit(words, from, end, true);
    if (on(from, past - from)) return;
    from = next_bit(words, past, end, false);
  }
}

}  // namespace

Bin::Bin(int cycles, int payload_bits)
    : cycles_(cycles), payload_bits_(payload_bits),
      words_(static_cast<std::size_t>((payload_bits + kWordBits - 1) / kWordBits)),
      used_(2 * static_cast<std::size_t>(cycles) * words_), owner_(2 * static_cast<std::size_t>(cycles), kFree) {
  TTF_CHECK(cycles >= 1 && cycles <= kMostCycles && std::has_single_bit(static_cast<unsigned>(cycles)), "{} cycles",
            cycles);
  TTF_CHECK(payload_bits >= 1 && payload_bits <= kMostPayloadBits, "{} bits", payload_bits);
}

std::optional<int> Bin::free_offset(int node, int repetition, int first_cycle, int bits) const {
  const std::size_t of = union_of(repetition, first_cycle);
  if (owner_[of] != kFree && owner_[of] != node) return std::nullopt;
  std::optional<int> offset;
  each_free_run(words(of), payload_bits_, [&](int first, int run) {
    if (run >= bits) offset = first;
    return offset.has_value();
  });
  return offset;
}

std::optional<Place> Bin::first_place(const Signal& signal, Fit fit) const {
  std::optional<Place> first;
  for (int cycle = signal.window.earliest; cycle <= signal.window.latest; ++cycle) {
    const auto offset = free_offset(signal.node, signal.repetition, cycle, signal.bits);
    if (!offset || (first && first->offset <= *offset)) continue;
    first = Place{0, cycle, *offset};
    if (fit == Fit::kLowestCycle || *offset == 0) break;
  }
  return first;
}

void Bin::occupy(int node, int repetition, int first_cycle, int offset, int bits) {
  for (int level = repetition; level <= cycles_; level *= 2)  // all unions of some of these cycles
    for (int cycle = first_cycle; cycle < level; cycle += repetition) {
      set(union_of(level, cycle), offset, bits);
      own(union_of(level, cycle), node);
    }
  for (int level = repetition / 2; level >= 1; level /= 2) {  // all unions that contain these cycles
    const std::size_t of = union_of(level, first_cycle % level);
    set(of, offset, bits);
    own(of, node);
  }
  used_bits_ += static_cast<std::int64_t>(bits) * (cycles_ / repetition);
}

void Bin::set(std::size_t of, int offset, int bits) {
  for (int bit = offset; bit < offset + bits; ++bit)
    used_[of * words_ + static_cast<std::size_t>(bit / kWordBits)] |= Word{1} << (bit % kWordBits);
}

void Bin::own(std::size_t of, int node) { owner_[of] = owner_[of] == kFree || owner_[of] == node ? node : kMixed; }

int Bin::room_for(int node, int repetition, int bits) const {
  int room = 0;
  for (int cycle = 0; cycle < repetition; ++cycle) {
    const std::size_t of = union_of(repetition, cycle);
    if (owner_[of] != kFree && owner_[of] != node) continue;
    each_free_run(words(of), payload_bits_, [&](int, int run) {
      room += run / bits;
      return false;
    });
  }
  return room;
}

}  // namespace ttf::schedules::synthesis::packing
