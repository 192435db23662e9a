#include "bus/wire/can_timing.h"

#include <algorithm>
#include <array>

#include "core/check.h"
#include "schedules/can_load.h"

namespace ttf::wire {
namespace {

// Classic base frame: SOF, identifier, RTR, IDE, r0 and DLC, in front of the data; the CRC behind it is stuffed too.
constexpr int kClassicHeader = 1 + 11 + 1 + 1 + 1 + 4;
constexpr int kClassicCrc = 15;

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

Duration can_frame_duration(const schedules::CanBus& bus, std::uint32_t identifier, std::span<const std::byte> data) {
  const int bytes = static_cast<int>(data.size());
  const auto code = static_cast<std::uint32_t>(std::lower_bound(kLengths.begin(), kLengths.end(), bytes) -
                                               kLengths.begin());
  TTF_CHECK(schedules::can_data_length(bus.flexible_data_rate, bytes) == bytes, "{} bytes is no CAN length", bytes);
  Stuffing stuffing;
  schedules::CanBits bits = schedules::can_unstuffed_bits(bus, bytes);
  if (bus.flexible_data_rate) {
    stuffing.bits(0, 1, false);                       // SOF
    stuffing.bits(identifier & 0x7FFu, 11, false);
    stuffing.bits(0b00101, 5, false);                 // RRS, IDE, FDF, res, BRS
    stuffing.bits(code, 5, true);                     // ESI (error active) and DLC
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
  return schedules::can_duration(bus, bits);
}

}  // namespace ttf::wire
