// FlexRay on CAN FD: maps the signals of a FlexRay channel to bytes on a CAN interface. Pure functions and one
// state. docs/media/socketcan.md describes the same for people who look at the bus with candump.
//
//   identifier        11 bits: the slot in which the frame is sent, 1..2047; 0 for symbols and follow-ups, because no
//                     slot has that number
//   whole frame       header, payload, frame CRC, as in FlexRay: 8..64 bytes
//   fragments         of a frame that does not fit, or is invalid by its own header: three bytes before up to 61 of it
//                       byte 0   1 0 lll iii   number of the last fragment, of this one, both from 0
//                       byte 1   n 0 cccccc    top bit of the frame's length, cycle count
//                       byte 2   nnnnnnnn      the frame's length in bytes, lower bits
//   symbol            kind (1 CAS or MTS, 2 wake-up, 3 noise), duration in ns (4 bytes, most significant first), CRC-24
//                     of these five with the channel's initial value
//   follow-up         4, slot (2 bytes), cycle count (1), lateness of the sync frame sent there and then in ns (4,
//                     two's complement), CRC-24 of these eight as above; no FlexRay signal, and without effect on the
//                     fragments around it
//
// CAN FD has no frame of, say, 26 bytes: zeros fill it up to the next length. The header of a whole frame
// states its length, and the header CRC must match. Bit 7 of byte 0, reserved in FlexRay and sent as 0,
// distinguishes the two forms. A frame can be sent in one form only, and a receiver accepts no other.
// Fragments follow one another on the bus; any other frame between them ends them.
//
// Nothing here allocates, throws, or reads a clock. The frame CRC is not judged here: a broken frame arrives
// as one, as on FlexRay (wire::decode_frame).
#pragma once

#include <linux/can.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "bus/ports/flexray_port.h"
#include "bus/wire/flexray_frame.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::socketcan {

inline constexpr int kSymbolIdentifier = 0;
inline constexpr int kLastSlot = 2047;
inline constexpr std::size_t kFragmentHeaderBytes = 3;
inline constexpr std::size_t kFragmentBytes = CANFD_MAX_DLEN - kFragmentHeaderBytes;
inline constexpr std::size_t kMaxFragments = (wire::kMaxFrameBytes + kFragmentBytes - 1) / kFragmentBytes;

// Returns the shortest CAN FD length for `bytes` bytes (0..64): 0..8, 12, 16, 20, 24, 32, 48, 64.
std::size_t can_fd_length(std::size_t bytes);

struct CanFrames {
  std::array<canfd_frame, kMaxFragments> frames;
  std::size_t count = 0;

  std::span<const canfd_frame> all() const { return std::span(frames).first(count); }
};
// Maps a frame of 8..262 bytes, correct or not, sent in slot 1..2047. The flag CANFD_BRS is set: data at the
// faster rate.
CanFrames frame_to_can(int slot, std::span<const std::byte> frame);
// Maps any signal except a frame; at most 4.29 s long.
canfd_frame symbol_to_can(schedules::model::Channel channel, ports::Signal symbol, Duration duration);

// A sender's report about a sync frame that it sent before: its lateness.
struct FollowUp {
  int slot = 0;                    // 1..2047
  std::uint8_t cycle_counter = 0;  // 0..63
  Duration late;                   // negative: earlier; within fits_follow_up()
};
// Returns whether a follow-up has room for that lateness: up to 2.14 s either way.
bool fits_follow_up(Duration late);
canfd_frame follow_up_to_can(schedules::model::Channel channel, const FollowUp& follow_up);

enum class Outcome : std::uint8_t {
  kComplete,   // a FlexRay frame, a symbol or a follow-up is complete
  kFragment,   // part of a frame that is not complete yet
  kForeign,    // outside this mapping: classic CAN, 29-bit identifiers, remote and error frames
  kMalformed,  // a CAN FD frame with an 11-bit identifier that no sender of ours sends
  kDisplaced,  // a fragment that does not continue the last one, or repeats one
};
inline constexpr std::size_t kOutcomes = 5;

struct Arrival {
  Outcome outcome{};
  bool abandoned = false;               // a frame with its first fragments here will stay incomplete
  int slot = 0;                         // for a complete frame or a fragment, displaced or not
  ports::Signal signal{};               // for a complete frame or symbol
  Duration duration{};                  // of a symbol
  std::span<const std::byte> frame{};   // a complete frame: valid like the received CAN frame, until the
                                        // next arrival
  std::optional<FollowUp> follow_up{};  // for a follow-up
};

// One channel's receiver, one per interface.
class Reassembly {
 public:
  explicit Reassembly(schedules::model::Channel channel) : channel_(channel) {}

  // `can.flags` must have CANFD_FDF if and only if it arrived as a CAN FD frame.
  Arrival arrive(const canfd_frame& can);
  // Returns how often this outcome occurred; abandoned frames count separately.
  std::uint64_t count(Outcome outcome) const { return counts_[static_cast<std::size_t>(outcome)]; }
  std::uint64_t abandoned() const { return abandoned_; }

 private:
  Arrival symbol(std::span<const std::byte> data) const;
  Arrival follow_up(std::span<const std::byte> data) const;
  Arrival whole(int slot, std::span<const std::byte> data) const;
  Arrival fragment(int slot, std::span<const std::byte> data);

  schedules::model::Channel channel_;
  // The frame begun: fragments 0..next_ - 1 of length_ bytes in slot_; no frame is begun while next_ is 0.
  std::size_t next_ = 0;
  int slot_ = 0;
  std::size_t length_ = 0;
  std::array<std::byte, wire::kMaxFrameBytes> bytes_{};
  std::array<std::uint64_t, kOutcomes> counts_{};
  std::uint64_t abandoned_ = 0;
};

}  // namespace ttf::bus::socketcan
