#include "bus/wire/can_timing.h"

#include <algorithm>
#include <array>

#include "core/check.h"
#include "core/int128.h"

namespace ttf::wire {
namespace {

// Bits at the nominal and at the data rate.
struct BitCount {
  std::int64_t nominal = 0;
  std::int64_t data = 0;
};

// Classic base frame: SOF, identifier, RTR, IDE, r0, DLC and the CRC are stuffed; CRC delimiter, ACK and its delimiter,
// seven EOF and three intermission bits are not.
constexpr int kClassicHeader = 1 + 11 + 1 + 1 + 1 + 4;
constexpr int kClassicCrc = 15;
// Unstuffed end of every frame, at the nominal rate.
constexpr int kTail = 1 + 1 + 1 + 7 + 3;
// FD base frame: SOF, identifier, RRS, IDE, FDF, res, BRS at the nominal rate; ESI and DLC at the data rate.
constexpr int kFdArbitration = 1 + 11 + 1 + 1 + 1 + 1 + 1;
constexpr int kFdControl = 1 + 4;

// Stuff count and CRC of an FD frame with their fixed stuff bits: one before the count, and one after every fourth bit.
// They stand at fixed places, so the CRC's value does not matter. The bit rate changes at the sample points within BRS
// and CRC delimiter; both bits count in full at the nominal rate, which is the longer.
int fd_crc_bits(int bytes) { return bytes <= 16 ? 4 + 17 + 6 : 4 + 21 + 7; }

Duration duration_of(const schedules::CanBus& bus, BitCount bits) {
  const Int128 numerator = (static_cast<Int128>(bits.nominal) * bus.data_bit_rate +
                            static_cast<Int128>(bits.data) * bus.nominal_bit_rate) * 1'000'000'000;
  const Int128 denominator = static_cast<Int128>(bus.nominal_bit_rate) * bus.data_bit_rate;
  return {static_cast<std::int64_t>((numerator + denominator - 1) / denominator)};
}

BitCount unstuffed(const schedules::CanBus& bus, int bytes) {
  if (!bus.flexible_data_rate) return {kClassicHeader + 8 * bytes + kClassicCrc + kTail, 0};
  return {kFdArbitration + kTail, kFdControl + 8 * bytes + fd_crc_bits(bytes)};
}

// Counts the stuff bits of a bit sequence: after five equal bits (stuff bits counted) the opposite one is inserted.
// In an FD frame stuffing ends with the data: where its last bits are five equal ones, the fixed stuff bit that follows
// anyhow is the only one (ISO 11898-1:2015, 10.5).
class Stuffing {
 public:
  void bit(bool value, bool data_rate) {
    if (value == last_ && run_ > 0)
      ++run_;
    else
      run_ = 1;
    last_ = value;
    pending_ = run_ == 5;
    if (pending_) {
      ++(data_rate ? data_ : nominal_);
      last_ = !value;
      run_ = 1;
    }
  }
  void bits(std::uint32_t value, int count, bool data_rate) {
    for (int b = count - 1; b >= 0; --b) bit((value >> b) & 1u, data_rate);
  }
  std::int64_t nominal() const { return nominal_; }
  std::int64_t data() const { return data_; }
  // The last bit of the sequence set off a stuff bit.
  bool pending() const { return pending_; }

 private:
  bool last_ = false, pending_ = false;
  int run_ = 0;
  std::int64_t nominal_ = 0, data_ = 0;
};

// CRC-15/CAN over the unstuffed bits from SOF to the end of data.
class Crc15 {
 public:
  void bits(std::uint32_t value, int count) {
    for (int b = count - 1; b >= 0; --b) {
      const bool feedback = (((crc_ >> 14) ^ (value >> b)) & 1u) != 0;
      crc_ = (crc_ << 1) & 0x7FFFu;
      if (feedback) crc_ ^= 0x4599u;
    }
  }
  std::uint32_t value() const { return crc_; }

 private:
  std::uint32_t crc_ = 0;
};

constexpr std::array<int, 16> kLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

}  // namespace

int can_length(bool flexible_data_rate, int bytes) {
  TTF_CHECK(bytes >= 0 && bytes <= (flexible_data_rate ? 64 : 8), "{} bytes", bytes);
  return *std::lower_bound(kLengths.begin(), kLengths.end(), bytes);
}

Duration can_frame_duration(const schedules::CanBus& bus, std::uint32_t identifier, std::span<const std::byte> data) {
  const int bytes = static_cast<int>(data.size());
  const auto code = static_cast<std::uint32_t>(std::lower_bound(kLengths.begin(), kLengths.end(), bytes) -
                                               kLengths.begin());
  TTF_CHECK(can_length(bus.flexible_data_rate, bytes) == bytes, "{} bytes is no CAN length", bytes);
  Stuffing stuffing;
  BitCount bits = unstuffed(bus, bytes);
  if (bus.flexible_data_rate) {
    stuffing.bits(0, 1, false);                       // SOF
    stuffing.bits(identifier & 0x7FFu, 11, false);
    stuffing.bits(0b00101, 5, false);                 // RRS, IDE, FDF, res, BRS
    stuffing.bits(code, kFdControl, true);            // ESI (error active) and DLC
    for (const std::byte byte : data) stuffing.bits(static_cast<std::uint32_t>(byte), 8, true);
    if (stuffing.pending()) --bits.data;
  } else {
    const std::uint32_t header = ((identifier & 0x7FFu) << 7) | code;   // SOF 0, id, RTR IDE r0 0, DLC
    Crc15 crc;
    crc.bits(header, kClassicHeader);
    stuffing.bits(header, kClassicHeader, false);
    for (const std::byte byte : data) {
      crc.bits(static_cast<std::uint32_t>(byte), 8);
      stuffing.bits(static_cast<std::uint32_t>(byte), 8, false);
    }
    stuffing.bits(crc.value(), kClassicCrc, false);
  }
  bits.nominal += stuffing.nominal();
  bits.data += stuffing.data();
  return duration_of(bus, bits);
}

Duration can_frame_worst_case(const schedules::CanBus& bus, int bytes) {
  const int length = can_length(bus.flexible_data_rate, bytes);
  BitCount bits = unstuffed(bus, length);
  // After the first bit, every fourth can need a stuff bit.
  if (bus.flexible_data_rate) {
    const int arbitration = (kFdArbitration - 1) / 4;
    bits.nominal += arbitration;
    bits.data += (kFdArbitration + kFdControl + 8 * length - 1) / 4 - arbitration;
  } else {
    bits.nominal += (kClassicHeader + kClassicCrc + 8 * length - 1) / 4;
  }
  return duration_of(bus, bits);
}

Duration can_frame_best_case(const schedules::CanBus& bus, int bytes) {
  return duration_of(bus, unstuffed(bus, can_length(bus.flexible_data_rate, bytes)));
}

}  // namespace ttf::wire
