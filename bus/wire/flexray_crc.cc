#include "bus/wire/flexray_crc.h"

#include <array>

namespace ttf::bus::wire {
namespace {

constexpr std::uint32_t kHeaderPolynomial = 0x385, kHeaderInit = 0x01A;
// The frame CRC lies in the upper 24 bits of 32, so that bytes are shifted out at the top.
constexpr std::uint32_t kFramePolynomial = 0x5D6DCBu << 8;
constexpr std::uint32_t kFrameInitA = 0xFEDCBAu << 8, kFrameInitB = 0xABCDEFu << 8;

// CRC-11 by four bits at once: it covers 20 bits, five such groups.
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

// Table k has the remainders of a byte followed by k zero bytes.
using FrameTables = std::array<std::array<std::uint32_t, 256>, 8>;
constexpr FrameTables make_frame_tables() {
  FrameTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 24;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x80000000u) ? kFramePolynomial : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before << 8) ^ tables[0][before >> 24];
    }
  return tables;
}
constexpr FrameTables kFrameTables = make_frame_tables();

}  // namespace

std::uint16_t header_crc(bool sync, bool startup, std::uint16_t frame_id, std::uint8_t payload_words) {
  const std::uint32_t bits =
      (sync ? 1u << 19 : 0u) | (startup ? 1u << 18 : 0u) | (static_cast<std::uint32_t>(frame_id) << 7) | payload_words;
  std::uint32_t crc = kHeaderInit;
  for (int shift = 16; shift >= 0; shift -= 4)
    crc = ((crc << 4) & 0x7FFu) ^ kHeaderTable[((crc >> 7) ^ (bits >> shift)) & 0xFu];
  return static_cast<std::uint16_t>(crc);
}

std::uint32_t frame_crc(schedules::model::Channel channel, std::span<const std::byte> header_and_payload) {
  std::uint32_t crc = channel == schedules::model::Channel::kA ? kFrameInitA : kFrameInitB;
  const std::byte* at = header_and_payload.data();
  std::size_t left = header_and_payload.size();
  const auto byte = [&at](std::size_t i) { return static_cast<std::uint32_t>(at[i]); };
  for (; left >= 8; at += 8, left -= 8) {
    crc ^= (byte(0) << 24) | (byte(1) << 16) | (byte(2) << 8) | byte(3);
    crc = kFrameTables[7][crc >> 24] ^ kFrameTables[6][(crc >> 16) & 0xFF] ^ kFrameTables[5][(crc >> 8) & 0xFF] ^
          kFrameTables[4][crc & 0xFF] ^ kFrameTables[3][byte(4)] ^ kFrameTables[2][byte(5)] ^ kFrameTables[1][byte(6)] ^
          kFrameTables[0][byte(7)];
  }
  for (; left > 0; ++at, --left) crc = (crc << 8) ^ kFrameTables[0][(crc >> 24) ^ byte(0)];
  return crc >> 8;
}

}  // namespace ttf::bus::wire
