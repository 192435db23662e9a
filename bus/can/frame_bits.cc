#include "bus/can/frame_bits.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::bus::can {

FrameBits::FrameBits(bool flexible_data_rate, std::uint32_t identifier, std::span<const std::byte> data,
                     bool error_passive)
    : flexible_data_rate_(flexible_data_rate) {
  const int bytes = static_cast<int>(data.size());
  const auto length = std::lower_bound(kDataLengths.begin(), kDataLengths.end(), bytes);
  TTF_CHECK(length != kDataLengths.end() && *length == bytes && (flexible_data_rate || bytes <= 8),
            "{} bytes is no CAN length", bytes);
  const auto code = static_cast<std::uint32_t>(length - kDataLengths.begin());
  stuffed(0, 1);  // start of frame
  stuffed(identifier & 0x7FFu, 11, true);
  stuffed(0, 1, true);  // RTR, on CAN FD RRS
  if (flexible_data_rate)
    stuffed(error_passive ? 0b01011 : 0b01010, 5);  // IDE, FDF, res, BRS, ESI
  else
    stuffed(0b00, 2);  // IDE, r0
  stuffed(code, 4);
  for (const std::byte byte : data) stuffed(static_cast<std::uint32_t>(byte), 8);
  if (flexible_data_rate)
    flexible_check(data.size());
  else
    classic_check();
  plain(1, 1);  // CRC delimiter
  put({true, false, false, true});
  plain(0xFF, 1 + 7);  // acknowledgement delimiter, end of frame
}

void FrameBits::put(FrameBit bit) {
  TTF_CHECK(size_ < kMost, "{} bits", size_);
  run_ = size_ > 0 && bits_[size_ - 1].recessive == bit.recessive ? run_ + 1 : 1;
  bits_[size_++] = bit;
}

void FrameBits::put_stuff_bit(bool arbitration) {
  const bool bit = !bits_[size_ - 1].recessive;
  put({bit, true, arbitration, false});
  ++stuff_bits_;
  crc17_.take(bit);  // on CAN FD it is covered
  crc21_.take(bit);
}

void FrameBits::stuffed(std::uint32_t value, int count, bool arbitration) {
  for (int b = count - 1; b >= 0; --b) {
    const bool bit = ((value >> b) & 1u) != 0;
    if (run_ == kEqualBits) put_stuff_bit(arbitration);
    put({bit, false, arbitration, false});
    crc15_.take(bit);
    crc17_.take(bit);
    crc21_.take(bit);
  }
}

void FrameBits::plain(std::uint32_t value, int count) {
  for (int b = count - 1; b >= 0; --b) put({((value >> b) & 1u) != 0, false, false, false});
}

void FrameBits::classic_check() {
  stuffed(crc15_.value(), crc15_.width());
  if (run_ == kEqualBits) put_stuff_bit(false);
}

// One fixed stuff bit first, and one after every fourth bit. Dynamic stuffing has ended with the data.
void FrameBits::flexible_check(std::size_t bytes) {
  const std::uint32_t count = stuff_count_bits(stuff_bits_);
  Crc crc = bytes <= static_cast<std::size_t>(kLongestShortCrc) ? crc17_ : crc21_;
  for (int b = 3; b >= 0; --b) crc.take(((count >> b) & 1u) != 0);
  const std::uint64_t check = std::uint64_t{count} << crc.width() | crc.value();
  for (int b = 4 + crc.width() - 1, n = 0; b >= 0; --b, ++n) {
    if (n % 4 == 0) put({!bits_[size_ - 1].recessive, true, false, false});
    put({((check >> b) & 1u) != 0, false, false, false});
  }
}

}  // namespace ttf::bus::can
