// The use of one slot over all cycles, with a quick search for free bits.
//
// A signal of repetition R and first cycle f needs bits that are free in each cycle c with c mod R == f. The unions of
// the used bits over these cycles are kept for every R and f, as a binary tree: the union of (R, f) is that of (2R, f)
// and (2R, f + R). So a search looks at one union, whatever R is.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "schedules/synthesis/packing/instance.h"

namespace ttf::schedules::synthesis::packing {

// The first place in a bin is that of the lowest cycle, or that of the lowest bit.
enum class Fit : std::uint8_t { kLowestCycle, kLowestBit };

class Bin {
 public:
  // All bits are free, and no node owns a frame.
  Bin(int cycles, int payload_bits);

  // Returns the first run of `bits` free bits in the cycles of (repetition, first_cycle), if these frames have no other
  // owner.
  std::optional<int> free_offset(int node, int repetition, int first_cycle, int bits) const;
  // Returns the first place in the signal's window; `bin` of it is not set.
  std::optional<Place> first_place(const Signal& signal, Fit fit) const;

  // Occupies bits, which must be free, and makes the node the owner of their frames.
  void occupy(int node, int repetition, int first_cycle, int offset, int bits);
  void occupy(const Signal& signal, const Place& place) {
    occupy(signal.node, signal.repetition, place.first_cycle, place.offset, signal.bits);
  }

  // Returns the used bits of all cycles.
  std::int64_t used_bits() const { return used_bits_; }
  // Returns how many more signals of that kind have room in the frames that the node owns or may own.
  int room_for(int node, int repetition, int bits) const;

 private:
  static constexpr int kFree = -1, kMixed = -2;
  using Word = std::uint64_t;

  std::size_t union_of(int repetition, int first_cycle) const {
    return static_cast<std::size_t>(repetition + first_cycle);
  }
  const Word* words(std::size_t of) const { return &used_[of * words_]; }
  void set(std::size_t of, int offset, int bits);
  void own(std::size_t of, int node);

  int cycles_, payload_bits_;
  std::size_t words_;
  std::vector<Word> used_;  // the unions, each of words_
  std::vector<int> owner_;  // for the same unions: a node, kFree or kMixed
  std::int64_t used_bits_ = 0;
};

}  // namespace ttf::schedules::synthesis::packing
