// The FlexRay frame (FlexRay 2.1A, chapter 4): 5-byte header, 0..127 two-byte words of payload, 3-byte trailer, all of
// it most significant bit first:
//
//   bit  39        38        37         36    35       34..24    23..17         16..6       5..0
//        reserved  preamble  null (0!)  sync  startup  frame id  payload words  header CRC  cycle
//
// Encoding takes what a controller of ours means to send: anything out of range is our bug and fails a check. Decoding
// takes any bytes at all and says what is wrong with them. Neither allocates; what a frame means is the caller's
// business.
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
  // The payload begins with a network management vector (static segment) or with a message id (dynamic segment); never
  // in a null frame.
  bool payload_preamble = false;
  bool null_frame = false;  // on the wire the indicator is inverted
  bool sync = false;
  bool startup = false;
  std::uint16_t frame_id = 0;  // 1..2047
  std::uint8_t payload_words = 0;
  std::uint16_t header_crc = 0;  // 11 bits
  std::uint8_t cycle = 0;        // 0..63
};

// Writes the whole frame and returns its length in bytes. payload_words and header_crc of `header` are not read: the
// first follows from `payload` (an even number of bytes, at most 254), the CRCs are computed. Checks the ranges above,
// that a startup frame is a sync frame, that a null frame has no preamble, and that `frame` has room.
std::size_t encode_frame(const FrameHeader& header, schedules::model::Channel channel,
                         std::span<const std::byte> payload, std::span<std::byte> frame);

enum class FrameError : std::uint8_t {
  kNone,
  kTooShort,  // no room for header and trailer; the header is not filled in
  kLength,    // the header's payload length is not what is there
  kHeaderCrc,
  kFrameCrc,      // also where the frame was sent on the other channel
  kReservedId,    // frame id 0
  kNullPreamble,  // a null frame with the payload preamble indicator set
};
struct DecodedFrame {
  FrameError error =
      FrameError::kNone;               // the first in the order: too short, header CRC, length, frame CRC, id, preamble
  FrameHeader header;                  // as on the wire, to be trusted only without error
  std::span<const std::byte> payload;  // into the bytes decoded
};
// `frame`: one whole frame as received on `channel`, without the bits of the physical layer. Sync and startup
// indicators and the cycle are the receiver's to judge: they depend on the slot.
DecodedFrame decode_frame(schedules::model::Channel channel, std::span<const std::byte> frame);

// A header taken apart, held against its own CRC or not; the one place that knows where its fields are.
FrameHeader parse_header(std::span<const std::byte, kHeaderBytes> header);
// The same of the beginning of a frame; nothing where its header is not there as a whole.
std::optional<FrameHeader> header_of(std::span<const std::byte> frame);
// Whether the header's CRC is that of its fields.
bool header_crc_holds(const FrameHeader& header);

// Both CRCs of any bytes, each by itself. Bytes that are too few for a header fail both; too few for a trailer, too, or
// not as many as the header says, fail the frame CRC.
struct FrameCrcs {
  bool header_holds = false;
  bool frame_holds = false;
};
FrameCrcs check_crcs(schedules::model::Channel channel, std::span<const std::byte> frame);

// Whether the header could be made out.
bool has_header(const DecodedFrame& frame);

// Of a dynamic frame: with payload preamble it begins with kMessageIdBytes, the more significant first. Nothing where
// the indicator is not set or the payload is too short for it.
std::optional<std::uint16_t> message_id(const DecodedFrame& frame);

// Of a static frame on the wire (schedules::frame_bits), in picoseconds; and in whole nanoseconds, rounded up: a frame
// is there when its last bit is.
std::int64_t frame_duration_ps(const schedules::model::GlobalParameters& flexray, int payload_words);
Duration frame_duration(const schedules::model::GlobalParameters& flexray, int payload_words);
// Words of payload in a frame of that many bytes, header and trailer included.
constexpr int words_in_frame(std::size_t frame_bytes) {
  return static_cast<int>((frame_bytes - kHeaderBytes - kTrailerBytes) / 2);
}

}  // namespace ttf::bus::wire
