// List buffers of the CNI: state-message buffers (Kopetz's temporal firewall). Reading never waits, writing
// never blocks, and a newer list replaces an older one.
//
//   L1  a list is handed out whole, every fragment of one sequence number and count, or not at all
//   L2  an older list never replaces a newer one. Sequence numbers compare on the circle of the field's 2^bits values
//       (as in RFC 1982): b is newer than a where (b - a) mod 2^bits is 1..2^(bits-1). Fragments older than the newest
//       list begun are stale and refused
//   L3  a sender that restarts its count is accepted at its kRestartLists-th list: so many consecutive stale lists,
//       each newer than the one before, with no other fragment between them, are no stragglers. The buffer begins
//       again with the last of them, as with its first list
//   L4  values that no sender of the layout writes are refused: a count or fragment index outside the layout, another
//       fragment than the slot's, a signal's code above its range
//
// The PDU layout sets the capacity at construction; nothing allocates afterwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "schedules/model/pdu.h"

namespace ttf::bus::cni {

// A complete list: the payloads of its fragments in order, each layout.fragment_bytes long.
struct ListView {
  std::uint32_t sequence = 0;  // unwrapped: counts on where the field on the bus wraps
  int fragments = 0;
  std::span<const std::byte> bytes;
};

// The sending side: the list that the controller transmits until the next write.
class OutgoingList {
 public:
  explicit OutgoingList(const schedules::model::PduLayout& layout);
  void write(const ListView& list);  // visible to the controller at once
  bool empty() const { return fragments_ == 0; }
  std::uint32_t sequence() const { return sequence_; }
  int fragments() const { return fragments_; }
  // Returns the payload of a fragment; empty if the current list has no such fragment (a null frame is sent).
  std::span<const std::byte> fragment(int index) const;

 private:
  std::vector<std::byte> bytes_;
  std::size_t fragment_bytes_;
  std::uint32_t sequence_ = 0;
  int fragments_ = 0;
};

enum class ArrivalEffect : std::uint8_t {
  kIncomplete,  // stored; fragments still missing
  kCompleted,   // the list is complete now and readable
  kDuplicate,   // this fragment of this sequence was there already (second channel, or repetition)
  kTorn,        // stored, incomplete; it displaced an incomplete list, which is lost: torn()
  kStale,       // its list is older than the newest begun one (L2); ignored
  kMalformed,   // values that no sender of this layout produces (L4); ignored
};

// The receiving side collects fragments in any order, from one or two channels, and offers the newest complete list.
class IncomingList {
 public:
  static constexpr int kRestartLists = 3;

  explicit IncomingList(const schedules::model::PduLayout& layout);
  // `fragment`: the slot's fragment, if the schedule fixes it (FlexRay); a CAN frame may carry any.
  ArrivalEffect arrive(std::span<const std::byte> payload, std::optional<int> fragment = std::nullopt);
  // Returns whether a repetition of that fragment would be kDuplicate and change nothing. The test compares it with
  // arrive() on drawn fragments (tests/bus/cni/list_buffer_test.cc).
  bool is_known(std::span<const std::byte> payload, int fragment) const {
    return stale_lists_ == 0 && repeats(payload, fragment);
  }
  // Returns the newest complete list, no value before the first. It stays until a newer one is complete.
  std::optional<ListView> latest() const;
  // Returns the list of the newest well-formed fragment, whatever its effect.
  std::uint32_t arrived() const { return arrived_sequence_; }
  // Returns the incomplete list that the newest fragment displaced, even if that fragment is a whole list.
  std::optional<std::uint32_t> torn() const { return torn_; }

 private:
  // A signal whose range has fewer codes than its bits.
  struct Bounded {
    std::size_t signal;
    std::uint32_t highest;
  };
  bool repeats(std::span<const std::byte> payload, int fragment) const;
  bool well_formed(std::span<const std::byte> payload, int fragment, int count) const;
  std::int64_t ahead(std::uint32_t raw, std::uint32_t of) const;
  bool restarted(std::uint32_t raw);
  void begin(std::uint32_t sequence, int count);
  ArrivalEffect store(std::span<const std::byte> payload, int fragment);

  const schedules::model::PduLayout* layout_;
  std::size_t sequence_signal_, fragment_signal_, count_signal_;
  std::vector<Bounded> bounded_;
  std::vector<std::byte> collecting_bytes_, complete_bytes_;
  std::vector<bool> present_;
  std::uint32_t collecting_sequence_ = 0, complete_sequence_ = 0, arrived_sequence_ = 0;
  int collecting_count_ = 0, collecting_fragments_ = 0, collecting_present_ = 0, complete_fragments_ = 0;
  std::optional<std::uint32_t> torn_;
  bool collecting_ = false, complete_ = false;
  std::uint32_t stale_raw_ = 0;  // the newest consecutive stale list's
  int stale_lists_ = 0;
};

}  // namespace ttf::bus::cni
