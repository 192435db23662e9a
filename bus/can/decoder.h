// A frame as its receivers make it out, bit by bit: stuffing, form and CRC (ISO 11898-1:2015, 10.4 to 10.11).
//
// Base frames only: a recessive IDE is a form error, and so is, on a CAN FD bus, a frame that is not CAN FD with
// bit-rate switching. On a classic bus the reserved bit may have either level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "bus/can/frame_bits.h"
#include "recording/records/enumerations.h"

namespace ttf::bus::can {

using recording::records::CanError;

class Decoder {
 public:
  enum class Part : std::uint8_t { kHeader, kData, kCheck, kCrcDelimiter, kSlot, kSlotDelimiter, kEnd, kOver };
  struct Taken {
    CanError error = CanError::kNone;
    bool accepted = false;  // the last but one bit of the end of frame has been received
    bool over = false;      // the last one has been received
    bool overload = false;  // it was dominant: no error of a receiver, but an overload condition
  };

  // Begins a frame; its start of frame is yet to be taken.
  void begin(bool flexible_data_rate);
  // Takes the next bit.
  Taken take(bool recessive);

  // Returns whether the next bit is the acknowledgement slot of a frame whose CRC is right.
  bool acknowledges() const { return part_ == Part::kSlot && sound_; }
  // Returns whether the next bit has the data rate.
  bool data_rate() const { return fast_; }
  std::uint32_t identifier() const { return identifier_; }
  std::span<const std::byte> data() const { return std::span<const std::byte>(data_).first(bytes_); }

 private:
  Taken header_bit(bool bit);
  Taken check_bit(bool bit);
  void data_bit(bool bit);
  void data_or_check();
  void checked();

  bool flexible_data_rate_ = false;
  Part part_ = Part::kHeader;
  bool stuffing_ = true, last_ = true, fast_ = false, sound_ = false, remote_ = false;
  int run_ = 0, stuff_bits_ = 0;
  int number_ = 0;           // the bit in its part, stuff bits not counted
  std::uint32_t field_ = 0;  // bits of the present field
  std::uint32_t identifier_ = 0;
  std::size_t bytes_ = 0;
  std::array<std::byte, 64> data_{};
  Crc crc15_ = kCrc15, crc17_ = kCrc17, crc21_ = kCrc21;
};

}  // namespace ttf::bus::can
