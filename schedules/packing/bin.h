// The use of one slot over all cycles, with a quick search for free bits.
//
// A signal of repetition R and first cycle f needs bits that are free in each cycle c with c mod R == f. The unions of
// the used bits over these cycles are kept for every R and f, as a binary tree: the union of (R, f) is that of (2R, f)
// and (2R, f + R). So a search looks at one union, whatever R is. Each variant of a vehicle has unions of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

// The first place in a bin is that of the lowest cycle, or that of the lowest bit.
enum class Fit : std::uint8_t { kLowestCycle, kLowestBit };

class Bin {
 public:
  // All bits are free, and no node owns a frame.
  explicit Bin(const Instance& instance);

  // Returns the first run of bits that are free for the signal from that cycle on, in all its variants, if its frames
  // have no other owner there. Unless slots are shared, the owner of one frame owns the bin.
  std::optional<int> free_offset(const Signal& signal, int first_cycle) const;
  // Returns the first place in the signal's window; `bin` of it is not set.
  std::optional<BitPlace> first_place(const Signal& signal, Fit fit) const;

  // Occupies bits, which must be free, and makes the signal's node the owner of their frames.
  void occupy(const Signal& signal, const BitPlace& place);
  // Keeps all signals out of these variants. They must be free.
  void block(VariantSet variants);

  // Returns the used bits of all cycles in all variants.
  std::int64_t used_bits() const { return used_bits_; }
  // Returns the variants in which some bits are used.
  VariantSet used_variants() const;
  // Returns how many more signals of that kind, in all variants, have room in the frames that the node owns or may own.
  int room_for(int node, int repetition, int bits) const;

 private:
  static constexpr int kFree = -1, kMixed = -2, kBlocked = -3;
  using Word = std::uint64_t;
  // Used bits in several variants.
  using Several = std::array<Word, (kMostPayloadBits + 63) / 64>;

  static std::size_t union_of(int repetition, int first_cycle) {
    return static_cast<std::size_t>(repetition + first_cycle);
  }
  std::size_t index(int variant, std::size_t of) const {
    return static_cast<std::size_t>(variant) * 2 * static_cast<std::size_t>(cycles_) + of;
  }
  bool may_own(int node, VariantSet variants, std::size_t of) const;
  const Word* used_in(VariantSet variants, std::size_t of, Several& several) const;
  void use(VariantSet variants, std::size_t of, const Signal& signal, int offset);

  int cycles_, payload_bits_;
  bool shared_slots_;
  VariantSet all_variants_;
  std::size_t words_;
  std::vector<Word> used_;  // by variant the unions, each of words_
  std::vector<int> owner_;  // for the same unions: a node, kFree, or one that no node may use
  std::int64_t used_bits_ = 0;
};

}  // namespace ttf::schedules::packing
