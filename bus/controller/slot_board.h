// What was seen in the static slots of a cycle, slot by slot and channel by channel (FlexRay 2.1A vSS): noted while the
// segment is under way, and kept until the next one is over, for the host to read.
//
// Reading taken of what goes on across a slot's boundary: it violates the boundary of every slot that it touches, of
// those that it covers from end to end, too. In the slot in which it began it is whatever else it was found to be, a
// syntax error where nobody can make it out; in the slots behind that it is the violation alone: a receiver stops
// decoding at the first boundary and waits for the channel to be idle, so nothing begins there that could be wrong.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "bus/controller/controller.h"

namespace ttf::bus::controller {

class SlotBoard {
 public:
  // Of one slot, by channel.
  struct Seen {
    std::array<bool, 2> valid{};           // a valid frame
    std::array<bool, 2> element{};         // a communication element has begun in it
    std::array<std::uint8_t, 2> errors{};  // SlotStatus

    bool nothing(std::size_t channel) const { return !element[channel] && errors[channel] == 0; }
    bool nothing() const { return (std::bit_cast<std::uint16_t>(element) | std::bit_cast<std::uint16_t>(errors)) == 0; }
  };

  // Static slots 1..`slots`.
  explicit SlotBoard(int slots) : seen_(static_cast<std::size_t>(slots)), kept_(seen_.size()), noted_(kept_.data()) {}
  SlotBoard(const SlotBoard&) = delete;
  SlotBoard& operator=(const SlotBoard&) = delete;

  int slots() const { return static_cast<int>(seen_.size()); }
  bool under_way() const { return under_way_; }

  // A schedule begins: nothing has been seen.
  void clear() {
    wipe(kept_);
    noted_ = kept_.data();
    under_way_ = false;
    begin_count();
  }
  void begin_segment() {
    wipe(seen_);
    noted_ = seen_.data();
    under_way_ = true;
    begin_count();
  }
  void end_segment() {
    seen_.swap(kept_);  // so noted_ is kept_'s
    under_way_ = false;
  }

  // Of the segment under way, or of the last one when that is over: what outlasts a segment is noted in it still.
  Seen& at(int slot) {
    only_pairs_ = false;
    return noted_[slot - 1];
  }
  const Seen& at(int slot) const { return noted_[slot - 1]; }
  // The common case, slot after slot: nothing but a valid frame on both channels. hear_a() and hear_b() are its halves,
  // for a slot in which nothing() was heard.
  bool nothing(int slot) const { return at(slot).nothing(); }
  void hear_a(int slot) { noted_[slot - 1].element[0] = noted_[slot - 1].valid[0] = true; }
  void hear_b(int slot) {
    noted_[slot - 1].element[1] = noted_[slot - 1].valid[1] = true;
    ++pairs_;
  }
  // Whether that is all that was heard in the segment, in as many slots; asked when the segment is over.
  bool are_pairs(int count) const { return only_pairs_ && pairs_ == count; }
  // Of the last segment that is over.
  const Seen& kept(int slot) const { return kept_[static_cast<std::size_t>(slot - 1)]; }

  // Something was going on from slot `first` to slot `last`, or beyond them, across boundaries.
  void crossed(schedules::model::Channel channel, int first, int last) {
    for (int slot = first; slot <= last; ++slot) at(slot).errors[index_of(channel)] |= kBoundaryViolation;
  }
  // The last slot in which something has begun or gone on; 0: in none.
  int last_heard(schedules::model::Channel channel) {
    int slot = slots();
    while (slot > 0 && at(slot).nothing(index_of(channel))) --slot;
    return slot;
  }

 private:
  // All zeros are Seen{}, and quicker written as such.
  static void wipe(std::vector<Seen>& board) {
    static_assert(std::is_trivially_copyable_v<Seen>);
    std::memset(static_cast<void*>(board.data()), 0, board.size() * sizeof(Seen));
  }
  void begin_count() {
    pairs_ = 0;
    only_pairs_ = true;
  }

  std::vector<Seen> seen_, kept_;  // by slot - 1
  Seen* noted_;                    // begin of the one that at() is of
  bool under_way_ = false;
  int pairs_ = 0;           // slots that hear_b() was told of
  bool only_pairs_ = true;  // nobody else has touched any
};

}  // namespace ttf::bus::controller
