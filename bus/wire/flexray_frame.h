// The FlexRay frame (FlexRay 2.1A, chapter 4): a 5-byte header, 0..127 two-byte words of payload, a 3-byte
// trailer, most significant bit first:
//
//   bit  39        38        37         36    35       34..24    23..17         16..6       5..0
//        reserved  preamble  null (0!)  sync  startup  frame id  payload words  header CRC  cycle
//
// Encoding checks its input: a value out of range is our bug. Decoding takes any bytes and reports their
// errors. Neither allocates, and neither interprets a frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "schedules/model/cluster.h"

namespace ttf::bus::wire {

inline constexpr std::size_t kHeaderBytes = 5;
inline constexpr std::size_t kTrailerBytes = 3;
inline constexpr std::size_t kMaxPayloadBytes = 254;
inline constexpr std::size_t kMaxFrameBytes = kHeaderBytes + kMaxPayloadBytes + kTrailerBytes;

struct FrameHeader {
  // The payload begins with a network management vector (static segment) or a message id (dynamic segment).
  // Never set in a null frame.
  bool payload_preamble = false;
  bool null_frame = false;  // inverted on the wire
  bool sync = false;
  bool startup = false;
  std::uint16_t frame_id = 0;  // 1..2047
  std::uint8_t payload_words = 0;
  std::uint16_t header_crc = 0;  // 11 bits
  std::uint8_t cycle = 0;        // 0..63
};

// Writes the whole frame and returns its length in bytes. It ignores payload_words and header_crc of `header`:
// the first follows from `payload` (an even number of bytes, at most 254), and the CRCs are computed. It
// checks the ranges above, that a startup frame is a sync frame, that a null frame has no preamble, and that
// `frame` has room.
std::size_t encode_frame(const FrameHeader& header, schedules::model::Channel channel,
                         std::span<const std::byte> payload, std::span<std::byte> frame);

enum class FrameError : std::uint8_t {
  kNone,
  kTooShort,  // no room for header and trailer; the header is not filled in
  kLength,    // the header's payload length is not the payload's
  kHeaderCrc,
  kFrameCrc,      // also if the frame was sent on the other channel
  kReservedId,    // frame id 0
  kNullPreamble,  // a null frame with the payload preamble indicator set
};
struct DecodedFrame {
  FrameError error = FrameError::kNone;  // the first error, in this order: too short, header CRC, length, frame CRC,
                                         // id, preamble
  FrameHeader header;                    // as on the wire; trustworthy only without error
  std::span<const std::byte> payload;    // into the bytes decoded
};
// Decodes one whole frame as received on `channel`, without the bits of the physical layer. The receiver
// judges the sync and startup indicators and the cycle, which depend on the slot.
DecodedFrame decode_frame(schedules::model::Channel channel, std::span<const std::byte> frame);

// Splits a header into its fields without checking its CRC; only this function has their places.
FrameHeader parse_header(std::span<const std::byte, kHeaderBytes> header);
// Splits the header at the beginning of a frame; returns no value if the header is incomplete.
std::optional<FrameHeader> header_of(std::span<const std::byte> frame);
// Returns whether the header CRC matches the header's fields.
bool header_crc_holds(const FrameHeader& header);

// Checks both CRCs of any bytes independently. Without a complete header both fail. The frame CRC also fails
// if the length is not the one that the header states.
struct FrameCrcs {
  bool header_holds = false;
  bool frame_holds = false;
};
FrameCrcs check_crcs(schedules::model::Channel channel, std::span<const std::byte> frame);

// Returns whether the header could be decoded.
bool has_header(const DecodedFrame& frame);

// Returns the message id, the first kMessageIdBytes of a dynamic frame with payload preamble, the more
// significant byte first. Returns no value if the indicator is not set or the payload is too short.
std::optional<std::uint16_t> message_id(const DecodedFrame& frame);

// Returns the time of a static frame on the wire (schedules::model::frame_bits): in picoseconds, and in whole
// nanoseconds. The latter is rounded up, because a frame has arrived only with its last bit.
std::int64_t frame_duration_ps(const schedules::model::GlobalParameters& flexray, int payload_words);
Duration frame_duration(const schedules::model::GlobalParameters& flexray, int payload_words);
// Returns the payload words of a frame with that many bytes, header and trailer included.
constexpr int words_in_frame(std::size_t frame_bytes) {
  return static_cast<int>((frame_bytes - kHeaderBytes - kTrailerBytes) / 2);
}

}  // namespace ttf::bus::wire
