// The CNI: state-message buffers for lists (Kopetz's temporal firewall). Reading never waits, writing never blocks, a
// newer list replaces an older one, and a list that is not complete under one sequence number is never handed out.
//
// Capacity is taken at construction from the PDU layout; nothing allocates afterwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "schedules/pdu.h"

namespace ttf::bus {

// A complete list: the payloads of its fragments one after the other, each layout.fragment_bytes long.
struct ListView {
  std::uint32_t sequence = 0;          // unwrapped: counts on where the bus' field wraps
  int fragments = 0;
  std::span<const std::byte> bytes;
};

// The sending side: what the controller transmits until the next write.
class OutgoingList {
 public:
  explicit OutgoingList(const schedules::PduLayout& layout);
  void write(const ListView& list);                        // visible to the controller at once
  bool empty() const { return fragments_ == 0; }
  std::uint32_t sequence() const { return sequence_; }
  int fragments() const { return fragments_; }
  // Payload of a fragment; empty where the current list has no such fragment (a null frame is sent).
  std::span<const std::byte> fragment(int index) const;

 private:
  std::vector<std::byte> bytes_;
  std::size_t fragment_bytes_;
  std::uint32_t sequence_ = 0;
  int fragments_ = 0;
};

enum class ArrivalEffect : std::uint8_t {
  kIncomplete,   // stored; fragments still missing
  kCompleted,    // the list is complete now and readable
  kDuplicate,    // this fragment of this sequence was there already (second channel, or repetition)
  kTorn,         // stored, incomplete; it displaced an incomplete list, which is lost: torn()
  kMalformed,    // header values that no sender of this layout produces; ignored
};

// The receiving side: collects fragments in any order, from one or two channels, and offers the newest complete list.
class IncomingList {
 public:
  explicit IncomingList(const schedules::PduLayout& layout);
  ArrivalEffect arrive(std::span<const std::byte> payload);
  // The newest complete list, or nothing yet. Stays the same until a newer one is complete.
  std::optional<ListView> latest() const;
  // Marks the latest as read; false if it had been read before.
  bool mark_read();
  bool unread() const { return complete_ && !read_; }
  // The list that is being collected (for the log).
  std::uint32_t collecting() const { return collecting_sequence_; }
  // The list that the newest well-formed fragment belongs to, whatever its effect.
  std::uint32_t arrived() const { return arrived_sequence_; }
  // The incomplete list that the newest fragment displaced, if it did: also where that fragment is a whole list itself.
  std::optional<std::uint32_t> torn() const { return torn_; }

 private:
  std::uint32_t unwrap(std::uint32_t raw) const;
  const schedules::PduLayout* layout_;
  std::size_t sequence_signal_, fragment_signal_, count_signal_;
  std::vector<std::byte> collecting_bytes_, complete_bytes_;
  std::vector<bool> present_;
  std::uint32_t collecting_sequence_ = 0, complete_sequence_ = 0, arrived_sequence_ = 0;
  int collecting_count_ = 0, collecting_fragments_ = 0, collecting_present_ = 0, complete_fragments_ = 0;
  std::optional<std::uint32_t> torn_;
  bool collecting_ = false, complete_ = false, read_ = false;
};

}  // namespace ttf::bus
