#include "bus/wire/can_timing.h"

#include <algorithm>
#include <array>

#include "core/check.h"
#include "schedules/analysis/can_load.h"

namespace ttf::bus::wire {
namespace {

// State after some bits: the last bit, and the length of its run, 1 to 4. A fifth equal bit sets off a stuff
// bit, the opposite one, which begins a new run.
struct StuffState {
  int run;
  bool last;
};
constexpr std::uint8_t packed(StuffState state) { return static_cast<std::uint8_t>(2 * (state.run - 1) + state.last); }
constexpr std::uint8_t kAfterBreak = packed({1, true});  // a lone one: no run goes on into a frame's first zero

struct StuffedByte {
  std::uint8_t next, stuff_bits;
};
constexpr StuffedByte stuffed(StuffState state, unsigned byte) {
  std::uint8_t stuff_bits = 0;
  for (int b = 7; b >= 0; --b) {
    const bool bit = ((byte >> b) & 1u) != 0;
    state = {bit == state.last ? state.run + 1 : 1, bit};
    if (state.run == 5) {
      ++stuff_bits;
      state = {1, !bit};
    }
  }
  return {packed(state), stuff_bits};
}

// Indexed by packed state and byte.
using StuffTable = std::array<std::array<StuffedByte, 256>, 8>;
constexpr StuffTable make_stuff_table() {
  StuffTable table{};
  for (int run = 1; run <= 4; ++run)
    for (const bool last : {false, true})
      for (unsigned byte = 0; byte < 256; ++byte) table[packed({run, last})][byte] = stuffed({run, last}, byte);
  return table;
}
constexpr StuffTable kStuffTable = make_stuff_table();

// Counts the stuff bits of a bit sequence. After five equal bits, stuff bits included, the opposite bit is
// inserted. In an FD frame stuffing ends with the data. If its last bits are five equal ones, only the fixed
// stuff bit follows (ISO 11898-1:2015, 10.5).
class Stuffing {
 public:
  void byte(std::uint32_t value) {
    const StuffedByte step = kStuffTable[state_][value];
    state_ = step.next;
    stuff_bits_ += step.stuff_bits;
    last_bit_ = value & 1u;
  }
  void bytes(std::uint32_t value, int count) {
    for (int b = count - 1; b >= 0; --b) byte((value >> (8 * b)) & 0xFFu);
  }
  void bytes(std::span<const std::byte> data) {
    for (const std::byte value : data) byte(static_cast<std::uint32_t>(value));
  }
  std::int64_t count() const { return stuff_bits_; }
  // Returns whether the last bit of the sequence set off a stuff bit.
  bool pending() const { return (state_ & 1u) != last_bit_; }

 private:
  std::uint32_t state_ = kAfterBreak, last_bit_ = 1;
  std::int64_t stuff_bits_ = 0;
};

// CRC-15/CAN over the unstuffed bits from SOF to the end of data. Zeros in front of SOF do not change it.
constexpr std::array<std::uint16_t, 256> make_crc_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 7;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x4000u) ? 0x4599u : 0u);
    table[byte] = static_cast<std::uint16_t>(crc & 0x7FFFu);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> kCrcTable = make_crc_table();

std::uint32_t crc15(std::uint32_t header, std::span<const std::byte> data) {
  std::uint32_t crc = 0;
  const auto byte = [&crc](std::uint32_t value) {
    crc = ((crc << 8) & 0x7FFFu) ^ kCrcTable[((crc >> 7) ^ value) & 0xFFu];
  };
  for (int shift = 16; shift >= 0; shift -= 8) byte(header >> shift);
  for (const std::byte value : data) byte(static_cast<std::uint32_t>(value));
  return crc;
}

// Alternating bits, which set off no stuff bit, fill fields up to whole bytes. In front of a field the fill
// ends in a one, as if after a break. Behind a field it begins with the opposite of the field's last bit.
constexpr std::uint32_t kFill3 = 0b101, kFill5 = 0b10101, kFill7 = 0b1010101;

constexpr std::array<int, 16> kLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

}  // namespace

CanFrameTimes can_frame_times(const schedules::model::CanBus& bus, std::uint32_t identifier,
                              std::span<const std::byte> data) {
  const int bytes = static_cast<int>(data.size());
  const auto code =
      static_cast<std::uint32_t>(std::lower_bound(kLengths.begin(), kLengths.end(), bytes) - kLengths.begin());
  TTF_CHECK(schedules::analysis::can_data_length(bus.flexible_data_rate, bytes) == bytes, "{} bytes is no CAN length",
            bytes);
  schedules::analysis::CanBits bits = schedules::analysis::can_unstuffed_bits(bus, bytes);
  if (bus.flexible_data_rate) {
    Stuffing nominal;
    nominal.bytes(kFill7 << 17 | (identifier & 0x7FFu) << 5 | 0b00101, 3);  // SOF 0, id, RRS IDE FDF res BRS
    // FDF, res and BRS alternate: BRS stands alone after any bits.
    Stuffing fast;
    fast.byte(kFill3 << 5 | code);  // ESI 0 (error active), DLC
    fast.bytes(data);
    bits.nominal += nominal.count();
    bits.data += fast.count() - (fast.pending() ? 1 : 0);
  } else {
    const std::uint32_t header = (identifier & 0x7FFu) << 7 | code;  // SOF 0, id, RTR IDE r0 0, DLC
    const std::uint32_t crc = crc15(header, data);                   // stuffed, too
    Stuffing stuffing;
    stuffing.bytes(kFill5 << 19 | header, 3);
    stuffing.bytes(data);
    stuffing.bytes(crc << 1 | (~crc & 1u), 2);
    bits.nominal += stuffing.count();
  }
  const schedules::analysis::CanBits until_accepted{bits.nominal - schedules::analysis::kBitsAfterAcceptance,
                                                    bits.data};
  return {schedules::analysis::can_duration(bus, until_accepted), schedules::analysis::can_duration(bus, bits)};
}

Duration can_frame_duration(const schedules::model::CanBus& bus, std::uint32_t identifier,
                            std::span<const std::byte> data) {
  return can_frame_times(bus, identifier, data).idle;
}

}  // namespace ttf::bus::wire
