// The FlexRay frame: 5-byte header, 0..127 two-byte words of payload, 3-byte trailer (FlexRay 2.1A, chapter 4).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "schedules/cluster.h"

namespace ttf::wire {

inline constexpr std::size_t kHeaderBytes = 5;
inline constexpr std::size_t kTrailerBytes = 3;
inline constexpr std::size_t kMaxPayloadBytes = 254;
inline constexpr std::size_t kMaxFrameBytes = kHeaderBytes + kMaxPayloadBytes + kTrailerBytes;

struct FrameHeader {
  bool payload_preamble = false;
  bool null_frame = false;      // on the wire the indicator is inverted
  bool sync = false;
  bool startup = false;
  std::uint16_t frame_id = 0;   // 1..2047
  std::uint8_t payload_words = 0;
  std::uint16_t header_crc = 0; // 11 bits
  std::uint8_t cycle = 0;       // 0..63
};

// Writes the whole frame, both CRCs computed, and returns its length in bytes. payload.size() must be even and <= 254.
std::size_t encode_frame(const FrameHeader& header, schedules::Channel channel, std::span<const std::byte> payload,
                         std::span<std::byte> frame);

enum class FrameError : std::uint8_t { kNone, kTooShort, kLength, kHeaderCrc, kFrameCrc, kReservedId };
struct DecodedFrame {
  FrameError error = FrameError::kNone;
  FrameHeader header;
  std::span<const std::byte> payload;
};
DecodedFrame decode_frame(schedules::Channel channel, std::span<const std::byte> frame);

// Of a static frame on the wire (schedules::frame_bits), in picoseconds; and in whole nanoseconds, rounded up: a frame is
// there when its last bit is.
std::int64_t frame_duration_ps(const schedules::GlobalParameters& flexray, int payload_words);
Duration frame_duration(const schedules::GlobalParameters& flexray, int payload_words);
// Words of payload in a frame of that many bytes, header and trailer included.
constexpr int words_in_frame(std::size_t frame_bytes) {
  return static_cast<int>((frame_bytes - kHeaderBytes - kTrailerBytes) / 2);
}

}  // namespace ttf::wire
