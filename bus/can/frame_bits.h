// A frame as its transmitter puts it on the wire, bit by bit, up to the end of its end of frame (ISO 11898-1:2015,
// 10.4 and 10.5). It is a base frame, classic or CAN FD with bit-rate switching. bus/wire/can_timing.h has the same
// frame's duration without its bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ttf::bus::can {

// The lengths of data by their code; a classic bus has the first nine.
inline constexpr std::array<int, 16> kDataLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
inline constexpr int kEqualBits = 5;         // set off a stuff bit
inline constexpr int kLongestShortCrc = 16;  // bytes of data with the CRC of 17 bits, on CAN FD

// The remainder of bits, one after the other, divided by a CRC's polynomial.
class Crc {
 public:
  constexpr Crc(int width, std::uint32_t polynomial, std::uint32_t start)
      : width_(width), polynomial_(polynomial), value_(start) {}
  constexpr void take(bool bit) {
    const bool top = ((value_ >> (width_ - 1)) & 1u) != 0;
    value_ = (value_ << 1) & ((1u << width_) - 1);
    if (top != bit) value_ ^= polynomial_;
  }
  constexpr std::uint32_t value() const { return value_; }
  constexpr int width() const { return width_; }

 private:
  int width_;
  std::uint32_t polynomial_, value_;
};
inline constexpr Crc kCrc15{15, 0x4599, 0};
inline constexpr Crc kCrc17{17, 0x1685B, 1u << 16};
inline constexpr Crc kCrc21{21, 0x102899, 1u << 20};

// Returns the four bits of CAN FD's stuff count: its number modulo 8 in Gray code, and their parity.
constexpr std::uint32_t stuff_count_bits(int stuff_bits) {
  const auto modulo = static_cast<std::uint32_t>(stuff_bits % 8);
  const std::uint32_t gray = modulo ^ (modulo >> 1);
  return gray << 1 | ((gray ^ (gray >> 1) ^ (gray >> 2)) & 1u);
}

struct FrameBit {
  bool recessive = true;
  bool stuff = false;
  bool arbitration = false;      // identifier or RTR, or a stuff bit among them
  bool acknowledgement = false;  // the slot in which receivers answer
};

class FrameBits {
 public:
  FrameBits() = default;
  // `data` must have a length that such a frame can have; of the identifier the low 11 bits count. A CAN FD frame
  // says whether its transmitter is error passive.
  FrameBits(bool flexible_data_rate, std::uint32_t identifier, std::span<const std::byte> data,
            bool error_passive = false);

  std::size_t size() const { return size_; }
  const FrameBit& operator[](std::size_t bit) const { return bits_[bit]; }

 private:
  static constexpr std::size_t kMost = 720;  // 64 bytes and all stuff bits: 708
  void put(FrameBit bit);
  void stuffed(std::uint32_t value, int count, bool arbitration = false);
  void plain(std::uint32_t value, int count);
  void put_stuff_bit(bool arbitration);
  void classic_check();
  void flexible_check(std::size_t bytes);

  std::array<FrameBit, kMost> bits_{};
  std::size_t size_ = 0;
  bool flexible_data_rate_ = false;
  int run_ = 0, stuff_bits_ = 0;
  Crc crc15_ = kCrc15, crc17_ = kCrc17, crc21_ = kCrc21;
};

}  // namespace ttf::bus::can
