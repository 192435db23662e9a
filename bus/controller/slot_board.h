// The slot board notes the status of each static slot on each channel (FlexRay 2.1A vSS) during a segment. It
// keeps it for the host until the next segment is over.
//
// Interpretation: activity across slot boundaries violates the boundary of every slot that it touches, also of
// those that it covers entirely. Its other errors, such as a syntax error, belong to the slot in which it
// began. The later slots have only the violation. A receiver stops decoding at the first boundary and waits
// for an idle channel, so no communication element begins there.
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
  // The status of one slot, by channel.
  struct Seen {
    std::array<bool, 2> valid{};    // a valid frame
    std::array<bool, 2> element{};  // a communication element has begun in the slot
    std::array<SlotStatus, 2> errors{};

    bool nothing(std::size_t channel) const { return !element[channel] && errors[channel] == kValidFrame; }
    bool nothing() const { return (std::bit_cast<std::uint16_t>(element) | std::bit_cast<std::uint16_t>(errors)) == 0; }
  };

  // Holds static slots 1..`slots`.
  explicit SlotBoard(int slots) : seen_(static_cast<std::size_t>(slots)), kept_(seen_.size()), noted_(kept_.data()) {}
  SlotBoard(const SlotBoard&) = delete;
  SlotBoard& operator=(const SlotBoard&) = delete;

  int slots() const { return static_cast<int>(seen_.size()); }
  bool under_way() const { return under_way_; }

  // A new schedule begins with an empty board.
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

  // The segment under way, or the last one after its end: activity that outlasts a segment is still noted in it.
  Seen& at(int slot) {
    only_pairs_ = false;
    return noted_[slot - 1];
  }
  const Seen& at(int slot) const { return noted_[slot - 1]; }
  // The common case: a valid frame on both channels in each slot. receive_a() and receive_b() are its
  // halves, for a slot without activity so far (nothing()). tests/bus/controller/fast_ways_test.cc compares with at().
  bool nothing(int slot) const { return at(slot).nothing(); }
  void receive_a(int slot) { noted_[slot - 1].element[0] = noted_[slot - 1].valid[0] = true; }
  void receive_b(int slot) {
    noted_[slot - 1].element[1] = noted_[slot - 1].valid[1] = true;
    ++pairs_;
  }
  // Returns whether the segment, now over, had only such pairs, in that many slots.
  bool are_pairs(int count) const { return only_pairs_ && pairs_ == count; }
  // The last segment that is over.
  const Seen& kept(int slot) const { return kept_[static_cast<std::size_t>(slot - 1)]; }

  // Notes activity across slot boundaries from slot `first` to slot `last`, or beyond them.
  void crossed(schedules::model::Channel channel, int first, int last) {
    for (int slot = first; slot <= last; ++slot) at(slot).errors[index_of(channel)] |= kBoundaryViolation;
  }
  // Returns the last slot with activity; 0 without any.
  int last_received(schedules::model::Channel channel) {
    int slot = slots();
    while (slot > 0 && at(slot).nothing(index_of(channel))) --slot;
    return slot;
  }

 private:
  // All zeros are Seen{}, and memset writes them faster.
  static void wipe(std::vector<Seen>& board) {
    static_assert(std::is_trivially_copyable_v<Seen>);
    std::memset(static_cast<void*>(board.data()), 0, board.size() * sizeof(Seen));
  }
  void begin_count() {
    pairs_ = 0;
    only_pairs_ = true;
  }

  std::vector<Seen> seen_, kept_;  // by slot - 1
  Seen* noted_;                    // the beginning of the board that at() reads
  bool under_way_ = false;
  int pairs_ = 0;           // slots counted by receive_b()
  bool only_pairs_ = true;  // at() has handed out no slot for changes
};

}  // namespace ttf::bus::controller
