// The content of one packet of a capture, for the two link types that this program writes and reads.
//
//   LINKTYPE_FLEXRAY (210)        | channel and type | error flags | header 5 | payload 0..254 |     no trailer
//                                 | channel and type | length in bits |                              a symbol
//   LINKTYPE_CAN_SOCKETCAN (227)  | identifier, big endian | length | FD flags | 0 | 0 | data 0..64 |
//
// Sources: https://www.tcpdump.org/linktypes/LINKTYPE_FLEXRAY.html and LINKTYPE_CAN_SOCKETCAN.html
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "bus/wire/flexray_frame.h"
#include "schedules/model/cluster.h"

namespace ttf::recording::capture {

enum class LinkType : std::uint16_t { kFlexRay = 210, kCan = 227 };

// Error flags of a FlexRay packet.
enum FlexRayErrors : std::uint8_t {
  kTssViolation = 0x01,
  kCodingError = 0x02,
  kFrameEndError = 0x04,
  kHeaderCrcError = 0x08,
  kFrameCrcError = 0x10,
};

// One logged FlexRay frame, taken apart: `header_and_payload` as on the wire without the trailer, and the
// result of our own checks.
struct CheckedFlexRayFrame {
  std::uint8_t errors = 0;  // FlexRayErrors
  bus::wire::FrameHeader header;
  std::span<const std::byte> header_and_payload;
};

// Computes both CRCs anew from `bytes` (header, payload, trailer). A frame cut short, or of another length than
// its header says, fails the frame CRC; without a whole header it also fails the header CRC.
CheckedFlexRayFrame check_flexray_frame(schedules::model::Channel channel, std::span<const std::byte> bytes);

// Checks a frame that could not be decoded to its end, as far as it came: `bytes` are its whole bytes, perhaps
// with the trailer.
CheckedFlexRayFrame check_broken_frame(schedules::model::Channel channel, std::span<const std::byte> bytes);

// Appends a packet of link type 210.
void put_flexray_packet(std::string& out, schedules::model::Channel channel, const CheckedFlexRayFrame& frame);

// Appends a symbol's packet of link type 210: the duration of its low phase in bits. The field has 7 bits:
// kLongestSymbolBits stands for itself and all longer ones, such as a wake-up pattern.
void put_symbol_packet(std::string& out, schedules::model::Channel channel, std::int64_t bits);
inline constexpr std::int64_t kLongestSymbolBits = 127;

// A captured packet of link type 210. Its content is not trusted: the header may be cut short, and the payload
// may have another length than the header says.
struct FlexRayPacket {
  enum class Kind : std::uint8_t { kFrame = 1, kSymbol = 2, kUnknown = 0 };
  Kind kind = Kind::kUnknown;
  schedules::model::Channel channel{};
  std::uint8_t errors = 0;    // FlexRayErrors of a frame
  int symbol_bits = 0;        // of a symbol
  bool whole_header = false;  // true if the frame has one; if false, the fields below are zero
  bus::wire::FrameHeader header;
  bool header_crc_holds = false;  // recomputed
  std::span<const std::byte> payload;
};
FlexRayPacket parse_flexray_packet(std::span<const std::byte> data);

// Appends a packet of link type 227. Identifiers up to 0x7ff are base identifiers, larger ones extended, or error
// frames. With
// `flexible_data_rate` the bit rate is switched too, as on every CAN FD of this program. At most 64 bytes of
// data are kept.
void put_can_packet(std::string& out, std::uint32_t identifier, bool flexible_data_rate,
                    std::span<const std::byte> data);

inline constexpr std::size_t kMaxCanData = 64;
inline constexpr std::uint32_t kLargestBaseIdentifier = 0x7ff;
inline constexpr std::uint32_t kExtendedIdentifier = 0x80000000u;
inline constexpr std::uint32_t kErrorFrame = 0x20000000u;  // in an identifier: a driver's report
inline constexpr std::uint8_t kBitRateSwitch = 1, kFlexibleDataRate = 4;

}  // namespace ttf::recording::capture
