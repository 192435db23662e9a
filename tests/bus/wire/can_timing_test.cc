#include "bus/wire/can_timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/can_load.h"
#include "tests/bus/can_buses.h"

namespace ttf::bus::wire {
namespace {

// Durations go from the start of frame to the end of the three intermission bits. Published lengths without
// intermission are three bits shorter: 108 instead of 111 unstuffed bits for 8 bytes, 132 instead of 135 in
// the worst case.

constexpr int kFdLengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

// The oracle writes the whole frame as on the wire, bit by bit: each with its rate, stuff bits in their
// places.
class WireFrame {
 public:
  struct Bit {
    bool level, fast, stuff;
  };

  static WireFrame classic_frame(std::uint32_t id, const std::vector<std::byte>& data) {
    WireFrame frame;
    frame.field(0, 1);  // start of frame
    frame.field(id, 11);
    frame.field(0, 3);  // RTR, IDE, r0
    frame.field(static_cast<std::uint32_t>(data.size()), 4);
    for (const std::byte byte : data) frame.field(static_cast<std::uint32_t>(byte), 8);
    frame.field(remainder(frame.plain_, 15, 0x4599, 0), 15);
    frame.tail();
    return frame;
  }

  static WireFrame fd_frame(std::uint32_t id, const std::vector<std::byte>& data) {
    WireFrame frame;
    frame.field(0, 1);
    frame.field(id, 11);
    frame.field(0b00101, 5);  // RRS, IDE, FDF, res, BRS
    frame.fast_ = true;
    frame.field(0, 1);  // ESI
    std::uint32_t code = 0;
    while (static_cast<std::size_t>(kFdLengths[code]) != data.size()) ++code;
    frame.field(code, 4);
    for (const std::byte byte : data) frame.field(static_cast<std::uint32_t>(byte), 8);
    // A dynamic stuff bit at the very end gives way to the fixed one.
    if (frame.bits_.back().stuff) frame.bits_.pop_back();
    // CRC over everything so far including the dynamic stuff bits, then over the stuff count.
    std::vector<bool> covered;
    int stuffed = 0;
    for (const Bit& bit : frame.bits_) {
      covered.push_back(bit.level);
      stuffed += bit.stuff ? 1 : 0;
    }
    const auto modulo = static_cast<std::uint32_t>(stuffed % 8);
    const std::uint32_t gray = modulo ^ (modulo >> 1);
    const std::uint32_t parity = (gray ^ (gray >> 1) ^ (gray >> 2)) & 1u;
    std::vector<bool> check;
    const auto put = [&](std::uint32_t value, int count) {
      for (int b = count - 1; b >= 0; --b) check.push_back((value >> b) & 1u);
    };
    put(gray << 1 | parity, 4);
    covered.insert(covered.end(), check.begin(), check.end());
    if (data.size() <= 16)
      put(remainder(covered, 17, 0x1685B, 1u << 16), 17);
    else
      put(remainder(covered, 21, 0x102899, 1u << 20), 21);
    for (std::size_t i = 0; i < check.size(); ++i) {
      if (i % 4 == 0) frame.bits_.push_back({!frame.bits_.back().level, true, true});
      frame.bits_.push_back({check[i], true, false});
    }
    frame.fast_ = false;
    frame.tail();
    return frame;
  }

  const std::vector<Bit>& bits() const { return bits_; }
  // The duration without the last bits; the rates divide a second's nanoseconds.
  Duration at(std::int64_t nominal, std::int64_t data, std::size_t without = 0) const {
    std::int64_t ns = 0;
    for (const Bit& bit : std::span(bits_).first(bits_.size() - without))
      ns += 1'000'000'000 / (bit.fast ? data : nominal);
    return {ns};
  }

 private:
  static std::uint32_t remainder(const std::vector<bool>& bits, int width, std::uint32_t polynomial,
                                 std::uint32_t start) {
    std::uint32_t value = start;
    for (const bool bit : bits) {
      const bool top = (value >> (width - 1)) & 1u;
      value = (value << 1) & ((1u << width) - 1);
      if (top != bit) value ^= polynomial;
    }
    return value;
  }

  // Dynamically stuffed.
  void field(std::uint32_t value, int count) {
    for (int b = count - 1; b >= 0; --b) {
      const bool level = (value >> b) & 1u;
      plain_.push_back(level);
      bits_.push_back({level, fast_, false});
      const std::size_t n = bits_.size();
      bool five = n >= 5;
      for (std::size_t i = n - std::min<std::size_t>(n, 5); five && i < n; ++i) five = bits_[i].level == level;
      if (five) bits_.push_back({!level, fast_, true});
    }
  }
  void tail() {
    // CRC delimiter, acknowledge and its delimiter, end of frame, intermission: never stuffed.
    for (int b = 0; b < 1 + 2 + 7 + 3; ++b) bits_.push_back({b != 1, false, false});
  }

  std::vector<bool> plain_;
  std::vector<Bit> bits_;
  bool fast_ = false;
};

std::vector<std::byte> drawn_data(RandomStream& stream, int length) {
  // Runs of equal bits of drawn length, to cause stuffing.
  std::vector<std::byte> data(static_cast<std::size_t>(length));
  bool level = false;
  std::int64_t run = 0;
  const std::int64_t longest = stream.integer(1, 9);
  for (int bit = 0; bit < 8 * length; ++bit) {
    if (run-- == 0) {
      level = !level;
      run = stream.integer(0, longest);
    }
    if (level) data[static_cast<std::size_t>(bit / 8)] |= static_cast<std::byte>(0x80u >> (bit % 8));
  }
  return data;
}

// The bounds are those the schedule reckons with (schedules/analysis/can_load.h).
TEST(CanTiming, ClassicFramesBitByBit) {
  RandomStream stream({6, 0, Purpose::kTest, 1, 0});
  for (int run = 0; run < 20'000; ++run) {
    const auto data = drawn_data(stream, static_cast<int>(stream.integer(0, 8)));
    const auto id = static_cast<std::uint32_t>(stream.integer(0, 2047));
    const Duration exact = can_frame_duration(classic(), id, data);
    ASSERT_EQ(exact, WireFrame::classic_frame(id, data).at(1'000'000, 1'000'000)) << run;
    ASSERT_GE(exact, schedules::analysis::can_best_case(classic(), static_cast<int>(data.size())));
    ASSERT_LE(exact, schedules::analysis::can_worst_case(classic(), static_cast<int>(data.size())));
  }
}

TEST(CanTiming, FlexibleDataRateFramesBitByBit) {
  RandomStream stream({6, 0, Purpose::kTest, 2, 0});
  for (int run = 0; run < 20'000; ++run) {
    const auto data = drawn_data(stream, kFdLengths[stream.integer(0, 15)]);
    const auto id = static_cast<std::uint32_t>(stream.integer(0, 2047));
    const Duration exact = can_frame_duration(fast(), id, data);
    ASSERT_EQ(exact, WireFrame::fd_frame(id, data).at(1'000'000, 5'000'000)) << run << " " << data.size();
    ASSERT_GE(exact, schedules::analysis::can_best_case(fast(), static_cast<int>(data.size())));
    ASSERT_LE(exact, schedules::analysis::can_worst_case(fast(), static_cast<int>(data.size())));
  }
}

// The code counts stuff bits by whole bytes. Every byte follows every other, so that each meets every
// preceding run.
TEST(CanTiming, EveryPairOfBytesBitByBit) {
  for (unsigned pair = 0; pair < 0x1'0000; ++pair) {
    const std::vector<std::byte> data{static_cast<std::byte>(pair >> 8), static_cast<std::byte>(pair & 0xFFu)};
    const std::uint32_t id = pair % 2048;
    ASSERT_EQ(can_frame_duration(classic(), id, data), WireFrame::classic_frame(id, data).at(1'000'000, 1'000'000))
        << pair;
    ASSERT_EQ(can_frame_duration(fast(), id, data), WireFrame::fd_frame(id, data).at(1'000'000, 5'000'000)) << pair;
  }
}

// The oracle's own frames obey the rules: no six equal bits up to the CRC's end. Fixed stuff bits differ from
// the bit before.
TEST(CanTiming, OracleFramesAreStuffed) {
  RandomStream stream({6, 0, Purpose::kTest, 3, 0});
  for (int run = 0; run < 2000; ++run) {
    const auto data = drawn_data(stream, kFdLengths[stream.integer(0, 15)]);
    for (const WireFrame& frame :
         {WireFrame::fd_frame(0x0F0, data), WireFrame::classic_frame(0x0F0, drawn_data(stream, 8))}) {
      int equal = 0;
      for (std::size_t i = 0; i + 13 < frame.bits().size(); ++i) {
        equal = i > 0 && frame.bits()[i].level == frame.bits()[i - 1].level ? equal + 1 : 1;
        ASSERT_LE(equal, 5);
        ASSERT_FALSE(i > 0 && frame.bits()[i].stuff && frame.bits()[i].level == frame.bits()[i - 1].level);
        ASSERT_FALSE(i > 0 && frame.bits()[i].stuff && frame.bits()[i - 1].stuff);
      }
    }
  }
}

// Five equal bits at the end of the data: only the fixed stuff bit follows (ISO 11898-1:2015, 10.5).
TEST(CanTiming, NoTwoStuffBitsInARowAtTheEndOfTheData) {
  // 0xA0 ends in five zeros, 0xA1 does not; no other stuffing is possible in the last byte.
  const std::vector<std::byte> ends_in_five{std::byte{0xAA}, std::byte{0xA0}};
  const std::vector<std::byte> ends_in_four{std::byte{0xAA}, std::byte{0xA1}};
  EXPECT_EQ(can_frame_duration(fast(), 0x555, ends_in_five), can_frame_duration(fast(), 0x555, ends_in_four));
  // In a classic frame, stuffing continues into the CRC: there the same byte costs its stuff bit.
  EXPECT_EQ(WireFrame::classic_frame(0x555, ends_in_five).at(1'000'000, 1'000'000),
            can_frame_duration(classic(), 0x555, ends_in_five));
}

// By hand, 8 bytes of 0x55 with identifier 0x555: SOF 0, id 10101010101, RRS IDE 00, FDF 1, res 0, BRS 1, ESI 0,
// DLC 1000, data 01010101: no five equal bits anywhere. 17 + 13 bits at 1 us, 5 + 64 + 27 at 0.2 us.
TEST(CanTiming, RatesSwitchAtBrsAndBackAtTheCrcDelimiter) {
  const std::vector<std::byte> data(8, std::byte{0x55});
  EXPECT_EQ(can_frame_duration(fast(), 0x555, data), Duration{30'000 + 96 * 200});
  // The long CRC from 20 bytes on: 4 + 21 bits and 7 fixed stuff bits instead of 4 + 17 and 6.
  const std::vector<std::byte> sixteen(16, std::byte{0x55}), twenty(20, std::byte{0x55});
  EXPECT_EQ(can_frame_duration(fast(), 0x555, sixteen), Duration{30'000 + (5 + 128 + 27) * 200});
  EXPECT_EQ(can_frame_duration(fast(), 0x555, twenty), Duration{30'000 + (5 + 160 + 32) * 200});
}

// The receivers wait for nine of the thirteen bits behind the CRC: its delimiter, two of the acknowledgement and six
// of the end of frame.
TEST(CanTiming, ReceiversAcceptAtTheLastButOneBitOfTheEndOfFrame) {
  RandomStream stream({6, 0, Purpose::kTest, 4, 0});
  for (int run = 0; run < 2000; ++run) {
    const auto id = static_cast<std::uint32_t>(stream.integer(0, 2047));
    for (const schedules::model::CanBus& bus : {classic(), fast()}) {
      const auto data = drawn_data(
          stream, bus.flexible_data_rate ? kFdLengths[stream.integer(0, 15)] : static_cast<int>(stream.integer(0, 8)));
      const CanFrameTimes times = can_frame_times(bus, id, data);
      const WireFrame frame =
          bus.flexible_data_rate ? WireFrame::fd_frame(id, data) : WireFrame::classic_frame(id, data);
      ASSERT_EQ(times.idle, frame.at(1'000'000, bus.data_bit_rate));
      ASSERT_EQ(times.accepted, frame.at(1'000'000, bus.data_bit_rate, 4));
    }
  }
}

TEST(CanTiming, RoundsUpToWholeNanoseconds) {
  schedules::model::CanBus odd = classic();
  odd.nominal_bit_rate = odd.data_bit_rate = 300'000;  // 3333.3 ns
  int rounded = 0;
  for (std::uint32_t id = 0; id < 64; ++id) {
    const auto bits = static_cast<std::int64_t>(WireFrame::classic_frame(id, {}).bits().size());
    rounded += bits % 3 != 0;
    EXPECT_EQ(can_frame_duration(odd, id, {}), Duration{(bits * 10'000 + 2) / 3}) << id;
    EXPECT_EQ(can_frame_times(odd, id, {}).accepted, Duration{((bits - 4) * 10'000 + 2) / 3}) << id;
  }
  EXPECT_GT(rounded, 10);
}

}  // namespace
}  // namespace ttf::bus::wire
