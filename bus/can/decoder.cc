#include "bus/can/decoder.h"

#include <algorithm>

namespace ttf::bus::can {
namespace {

constexpr int kStuffCountBits = 4;

}  // namespace

void Decoder::begin(bool flexible_data_rate) {
  *this = {};
  flexible_data_rate_ = flexible_data_rate;
}

Decoder::Taken Decoder::take(bool recessive) {
  const bool before = last_;
  const int run = run_;
  run_ = recessive == before && run > 0 ? run + 1 : 1;
  last_ = recessive;
  if (stuffing_ && run == kEqualBits) {
    if (recessive == before) return {CanError::kStuff};
    ++stuff_bits_;
    crc17_.take(recessive);
    crc21_.take(recessive);
    if (part_ == Part::kCrcDelimiter) stuffing_ = false;  // the stuff bit behind a classic frame's CRC
    return {};
  }
  switch (part_) {
    case Part::kHeader: return header_bit(recessive);
    case Part::kData: return data_bit(recessive), Taken{};
    case Part::kCheck:
      if (flexible_data_rate_ && number_ % 5 == 0) {  // a fixed stuff bit
        ++number_;
        return {recessive == before ? CanError::kForm : CanError::kNone};
      }
      return check_bit(recessive);
    case Part::kCrcDelimiter:
      if (!recessive) return {CanError::kForm};
      part_ = Part::kSlot;
      return {};
    case Part::kSlot: part_ = Part::kSlotDelimiter; return {};
    case Part::kSlotDelimiter:
      if (!recessive) return {CanError::kForm};
      if (!sound_) return {CanError::kCrc};
      part_ = Part::kEnd;
      number_ = 0;
      return {};
    case Part::kEnd:
      ++number_;
      if (number_ == 7) {
        part_ = Part::kOver;
        return {CanError::kNone, false, true, !recessive};
      }
      if (!recessive) return {CanError::kForm};
      return {CanError::kNone, number_ == 6};
    case Part::kOver: break;
  }
  return {};
}

Decoder::Taken Decoder::header_bit(bool bit) {
  crc15_.take(bit);
  crc17_.take(bit);
  crc21_.take(bit);
  const int n = number_++;
  field_ = field_ << 1 | (bit ? 1u : 0u);
  const int code_from = flexible_data_rate_ ? 18 : 15;
  if (n == 0) field_ = 0;  // start of frame
  if (n == 11) identifier_ = field_;
  if (n == 12) remote_ = bit && !flexible_data_rate_;
  if (n == 13 && bit) return {CanError::kForm};  // IDE
  if (flexible_data_rate_) {
    if ((n == 14 || n == 16) && !bit) return {CanError::kForm};  // FDF, BRS
    if (n == 15 && bit) return {CanError::kForm};                // res
    if (n == 16) fast_ = true;
  }
  if (n == code_from - 1) field_ = 0;
  if (n < code_from + 3) return {};
  const int length = kDataLengths[field_];
  bytes_ = remote_ ? 0 : static_cast<std::size_t>(flexible_data_rate_ ? length : std::min(length, 8));
  number_ = 0;
  field_ = 0;
  part_ = Part::kData;
  data_or_check();
  return {};
}

void Decoder::data_bit(bool bit) {
  crc15_.take(bit);
  crc17_.take(bit);
  crc21_.take(bit);
  const auto byte = static_cast<std::size_t>(number_ / 8);
  data_[byte] = static_cast<std::byte>(static_cast<unsigned>(data_[byte]) << 1 | (bit ? 1u : 0u));
  ++number_;
  data_or_check();
}

// Goes on to the CRC behind the last bit of the data. On CAN FD stuffing ends there.
void Decoder::data_or_check() {
  if (number_ < 8 * static_cast<int>(bytes_)) return;
  part_ = Part::kCheck;
  number_ = 0;
  field_ = 0;
  if (flexible_data_rate_) stuffing_ = false;
}

Decoder::Taken Decoder::check_bit(bool bit) {
  field_ = field_ << 1 | (bit ? 1u : 0u);
  ++number_;
  if (!flexible_data_rate_) {
    if (number_ == crc15_.width()) {
      sound_ = field_ == crc15_.value();
      checked();
    }
    return {};
  }
  const bool is_long = bytes_ > static_cast<std::size_t>(kLongestShortCrc);
  Crc& crc = is_long ? crc21_ : crc17_;
  if (number_ == 1 + kStuffCountBits) {  // behind the first fixed stuff bit
    sound_ = field_ == stuff_count_bits(stuff_bits_);
    for (int b = kStuffCountBits - 1; b >= 0; --b) crc.take(((field_ >> b) & 1u) != 0);
    field_ = 0;
  }
  const int bits = kStuffCountBits + crc.width();
  if (number_ == bits + (bits + 3) / 4) {
    sound_ = sound_ && field_ == crc.value();
    fast_ = false;
    checked();
  }
  return {};
}

void Decoder::checked() {
  part_ = Part::kCrcDelimiter;
  if (run_ != kEqualBits) stuffing_ = false;
}

}  // namespace ttf::bus::can
