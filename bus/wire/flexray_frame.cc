#include "bus/wire/flexray_frame.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::wire {
namespace {

constexpr std::uint32_t kHeaderPolynomial = 0x385, kHeaderInit = 0x01A;    // 11 bits
constexpr std::uint32_t kFramePolynomial = 0x5D6DCB;                       // 24 bits
constexpr std::uint32_t kFrameInitA = 0xFEDCBA, kFrameInitB = 0xABCDEF;

constexpr std::array<std::uint32_t, 256> make_frame_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 16;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x800000u) ? kFramePolynomial : 0u);
    table[byte] = crc & 0xFFFFFFu;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kFrameTable = make_frame_table();

// CRC-11 of four bits at once: the 20 bits it covers are five of them.
constexpr std::array<std::uint32_t, 16> make_header_table() {
  std::array<std::uint32_t, 16> table{};
  for (std::uint32_t nibble = 0; nibble < 16; ++nibble) {
    std::uint32_t crc = nibble << 7;
    for (int bit = 0; bit < 4; ++bit) crc = (crc << 1) ^ ((crc & 0x400u) ? kHeaderPolynomial : 0u);
    table[nibble] = crc & 0x7FFu;
  }
  return table;
}
constexpr std::array<std::uint32_t, 16> kHeaderTable = make_header_table();

}  // namespace

std::uint16_t header_crc(bool sync, bool startup, std::uint16_t frame_id, std::uint8_t payload_words) {
  // 20 bits: sync, startup, 11 of the frame id, 7 of the length.
  const std::uint32_t bits = (sync ? 1u << 19 : 0u) | (startup ? 1u << 18 : 0u) |
                             (static_cast<std::uint32_t>(frame_id) << 7) | payload_words;
  std::uint32_t crc = kHeaderInit;
  for (int shift = 16; shift >= 0; shift -= 4)
    crc = ((crc << 4) & 0x7FFu) ^ kHeaderTable[((crc >> 7) ^ (bits >> shift)) & 0xFu];
  return static_cast<std::uint16_t>(crc);
}

std::uint32_t frame_crc(schedules::Channel channel, std::span<const std::byte> header_and_payload) {
  std::uint32_t crc = channel == schedules::Channel::kA ? kFrameInitA : kFrameInitB;
  for (const std::byte byte : header_and_payload)
    crc = ((crc << 8) & 0xFFFFFFu) ^ kFrameTable[((crc >> 16) ^ static_cast<std::uint32_t>(byte)) & 0xFFu];
  return crc;
}

std::size_t encode_frame(const FrameHeader& header, schedules::Channel channel, std::span<const std::byte> payload,
                         std::span<std::byte> frame) {
  const std::size_t size = kHeaderBytes + payload.size() + kTrailerBytes;
  TTF_CHECK(payload.size() % 2 == 0 && payload.size() <= kMaxPayloadBytes && frame.size() >= size,
            "payload {} bytes, room {}", payload.size(), frame.size());
  TTF_CHECK(header.frame_id >= 1 && header.frame_id <= 2047 && header.cycle <= 63, "frame id {} cycle {}",
            header.frame_id, header.cycle);
  TTF_CHECK(header.sync || !header.startup, "a startup frame is a sync frame");
  const auto words = static_cast<std::uint8_t>(payload.size() / 2);
  const std::uint64_t crc = header_crc(header.sync, header.startup, header.frame_id, words);
  const std::uint64_t bits = (header.payload_preamble ? std::uint64_t{1} << 38 : 0) |
                             (header.null_frame ? 0 : std::uint64_t{1} << 37) |
                             (header.sync ? std::uint64_t{1} << 36 : 0) |
                             (header.startup ? std::uint64_t{1} << 35 : 0) |
                             (static_cast<std::uint64_t>(header.frame_id) << 24) |
                             (static_cast<std::uint64_t>(words) << 17) | (crc << 6) | header.cycle;
  for (std::size_t i = 0; i < kHeaderBytes; ++i) frame[i] = static_cast<std::byte>((bits >> (8 * (4 - i))) & 0xFF);
  std::copy(payload.begin(), payload.end(), frame.begin() + kHeaderBytes);
  const std::uint32_t trailer = frame_crc(channel, frame.first(kHeaderBytes + payload.size()));
  for (std::size_t i = 0; i < kTrailerBytes; ++i)
    frame[kHeaderBytes + payload.size() + i] = static_cast<std::byte>((trailer >> (8 * (2 - i))) & 0xFF);
  return size;
}

DecodedFrame decode_frame(schedules::Channel channel, std::span<const std::byte> frame) {
  DecodedFrame decoded;
  if (frame.size() < kHeaderBytes + kTrailerBytes) {
    decoded.error = FrameError::kTooShort;
    return decoded;
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kHeaderBytes; ++i) bits = (bits << 8) | static_cast<std::uint64_t>(frame[i]);
  FrameHeader& header = decoded.header;
  header.payload_preamble = (bits >> 38) & 1;
  header.null_frame = !((bits >> 37) & 1);
  header.sync = (bits >> 36) & 1;
  header.startup = (bits >> 35) & 1;
  header.frame_id = static_cast<std::uint16_t>((bits >> 24) & 0x7FF);
  header.payload_words = static_cast<std::uint8_t>((bits >> 17) & 0x7F);
  header.header_crc = static_cast<std::uint16_t>((bits >> 6) & 0x7FF);
  header.cycle = static_cast<std::uint8_t>(bits & 0x3F);
  const std::size_t payload = frame.size() - kHeaderBytes - kTrailerBytes;
  std::uint32_t trailer = 0;
  for (const std::byte byte : frame.last(kTrailerBytes)) trailer = (trailer << 8) | static_cast<std::uint32_t>(byte);
  if (header_crc(header.sync, header.startup, header.frame_id, header.payload_words) != header.header_crc)
    decoded.error = FrameError::kHeaderCrc;
  else if (payload != std::size_t{2} * header.payload_words)
    decoded.error = FrameError::kLength;
  else if (frame_crc(channel, frame.first(kHeaderBytes + payload)) != trailer)
    decoded.error = FrameError::kFrameCrc;
  else if (header.frame_id == 0)
    decoded.error = FrameError::kReservedId;
  decoded.payload = frame.subspan(kHeaderBytes, payload);
  return decoded;
}

int frame_bits(const schedules::GlobalParameters& flexray, int payload_words) {
  // TSS, FSS, ten bits (with their byte start sequence) for each of 8 header and trailer bytes and the payload, FES.
  return flexray.gdTSSTransmitter + 1 + 80 + 20 * payload_words + 2;
}

std::int64_t frame_duration_ps(const schedules::GlobalParameters& flexray, int payload_words) {
  return frame_bits(flexray, payload_words) * flexray.gdBit_ps;
}

}  // namespace ttf::wire
