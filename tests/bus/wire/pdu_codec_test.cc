#include "bus/wire/pdu_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/random.h"
#include "tests/bus/layouts.h"

namespace ttf::bus::wire {
namespace {

using bus::derive;
using bus::signal;

// The payload as a text of 0 and 1, most significant bit first.
std::string bit_text(std::span<const std::byte> payload) {
  std::string text;
  for (const std::byte byte : payload)
    for (int b = 7; b >= 0; --b) text += (static_cast<unsigned>(byte) >> b) & 1u ? '1' : '0';
  return text;
}

TEST(PduCodec, SignalsAreMostSignificantBitFirstWithoutGaps) {
  schedules::model::PduLayout layout;
  layout.name = "packed";
  layout.elements_per_fragment = 2;
  layout.header = {signal("a", 3), signal("b", 7)};
  layout.element = {signal("x", 5), signal("y", 6)};
  derive(layout.header, layout.header_bits);
  derive(layout.element, layout.element_bits);
  layout.header_bits = 16;
  layout.fragment_bytes = 5;
  std::vector<std::byte> payload(5);
  write_header_raw(layout, payload, 0, 0b101);
  write_header_raw(layout, payload, 1, 0b0110011);
  write_element_raw(layout, payload, 0, 0, 0b10001);
  write_element_raw(layout, payload, 1, 1, 0b110101);
  EXPECT_EQ(bit_text(payload),
            "1010110011000000"
            "10001000000"
            "00000110101"
            "00");
  EXPECT_EQ(read_header_raw(layout, payload, 1), 0b0110011u);
  EXPECT_EQ(read_element_raw(layout, payload, 1, 1), 0b110101u);
}

// Any widths at any offsets, in payloads of two bytes and of many. Written values are read back, and all
// other bits stay.
TEST(PduCodec, RoundTripLeavesTheNeighboursAlone) {
  RandomStream stream({5, 0, Purpose::kTest, 1, 0});
  int shorter = 0, as_long = 0, longer = 0;  // than the 64 bits handled at once
  for (int run = 0; run < 600; ++run) {
    schedules::model::PduLayout layout;
    layout.name = "drawn";
    const auto elements = stream.integer(1, 3), signals = stream.integer(1, 5), widest = stream.integer(1, 32);
    layout.elements_per_fragment = static_cast<int>(elements);
    layout.header = {signal("h", static_cast<int>(stream.integer(1, widest)))};
    for (int s = 0; s < signals; ++s)
      layout.element.push_back(signal("e", static_cast<int>(stream.integer(1, widest))));
    derive(layout.header, layout.header_bits);
    derive(layout.element, layout.element_bits);
    layout.header_bits = (layout.header_bits + 7) / 8 * 8;
    layout.fragment_bytes = (layout.header_bits + layout.elements_per_fragment * layout.element_bits + 7) / 8;
    ++(layout.fragment_bytes < 8 ? shorter : layout.fragment_bytes == 8 ? as_long : longer);
    std::vector<std::byte> payload(static_cast<std::size_t>(layout.fragment_bytes));
    for (std::byte& byte : payload) byte = static_cast<std::byte>(stream.integer(0, 255));
    for (int write = 0; write < 20; ++write) {
      const int element = static_cast<int>(stream.integer(0, elements - 1));
      const auto s = static_cast<std::size_t>(stream.integer(0, signals - 1));
      const schedules::model::Signal& chosen = layout.element[s];
      const auto value = static_cast<std::uint32_t>(stream.integer(0, (std::int64_t{1} << chosen.bits) - 1));
      std::string expected = bit_text(payload);
      const auto first =
          static_cast<std::size_t>(layout.header_bits + element * layout.element_bits + chosen.bit_offset);
      for (int b = 0; b < chosen.bits; ++b)
        expected[first + static_cast<std::size_t>(b)] = (value >> (chosen.bits - 1 - b)) & 1u ? '1' : '0';
      write_element_raw(layout, payload, element, s, value);
      ASSERT_EQ(bit_text(payload), expected);
      ASSERT_EQ(read_element_raw(layout, payload, element, s), value);
    }
  }
  EXPECT_GT(std::min({shorter, as_long, longer}), 5);
}

TEST(PduCodec, PhysicalValuesRoundToHalfAResolution) {
  const schedules::model::Signal speed = signal("speed", 12, -20.0, 0.05);
  RandomStream stream({5, 0, Purpose::kTest, 2, 0});
  for (int run = 0; run < 2000; ++run) {
    const double value = stream.uniform(speed.low, speed.high);
    ASSERT_NEAR(to_physical(speed, to_raw(speed, value)), value, 0.5 * speed.resolution * (1.0 + 1e-9));
  }
  for (std::uint32_t raw = 0; raw < 4096; ++raw) ASSERT_EQ(to_raw(speed, to_physical(speed, raw)), raw);
}

// The standard library's rounding, also half way between two codes and just beside.
TEST(PduCodec, RoundsHalfAwayFromZero) {
  RandomStream stream({5, 0, Purpose::kTest, 3, 0});
  for (int run = 0; run < 20'000; ++run) {
    const schedules::model::Signal s = signal("s", 32, stream.uniform(-100.0, 100.0), run % 2 == 0 ? 0.25 : 0.01);
    const auto code = static_cast<double>(stream.integer(0, std::int64_t{1} << stream.integer(1, 32)));
    double value = s.low + (code + 0.5) * s.resolution;
    if (run % 3 > 0) value = std::nextafter(value, run % 3 == 1 ? s.low : s.high);
    value = std::clamp(value, s.low, s.high);
    const long long rounded = std::llround((value - s.low) / s.resolution);
    ASSERT_EQ(to_raw(s, value), static_cast<std::uint32_t>(std::min(rounded, 0xFFFF'FFFFLL))) << run;
  }
}

TEST(PduCodec, SaturatesAndCounts) {
  schedules::model::Signal s = signal("s", 8, -10.0, 0.1);
  s.high = 10.0;
  int saturated = 0;
  EXPECT_EQ(to_raw(s, -10.1, &saturated), 0u);
  EXPECT_EQ(to_raw(s, 10.1, &saturated), 200u);
  EXPECT_EQ(to_raw(s, std::numeric_limits<double>::infinity(), &saturated), 200u);
  EXPECT_EQ(to_raw(s, -std::numeric_limits<double>::infinity(), &saturated), 0u);
  EXPECT_EQ(saturated, 4);
  EXPECT_EQ(to_raw(s, 10.0, &saturated), 200u);
  EXPECT_EQ(saturated, 4);
  EXPECT_EQ(to_raw(s, 99.0), 200u);  // without a counter
}

// The loader admits a `high` half a resolution above the last code; it must not wrap round to zero.
TEST(PduCodec, TheTopOfTheRangeDoesNotWrap) {
  schedules::model::Signal s = signal("s", 8);
  s.high = 255.5;
  EXPECT_EQ(to_raw(s, 255.5), 255u);
  schedules::model::Signal widest = signal("w", 32);
  EXPECT_EQ(to_raw(widest, 1e12), 0xFFFFFFFFu);
}

TEST(PduCodec, CodesAboveTheRangeAreReported) {
  schedules::model::Signal s = signal("s", 8, -10.0, 0.1);
  s.high = 10.0;
  EXPECT_EQ(highest_code(s), 200u);
  for (std::uint32_t raw = 0; raw < 256; ++raw) {
    int out_of_range = 0;
    const double physical = to_physical(s, raw, &out_of_range);
    ASSERT_EQ(out_of_range, raw > 200 ? 1 : 0) << raw;
    ASSERT_EQ(physical, raw > 200 ? 10.0 : -10.0 + raw * 0.1) << raw;
    ASSERT_EQ(to_physical(s, raw), physical);
  }
  // When the range ends between two codes, `high` is written as the nearer one, which is the highest.
  s.high = 9.97;
  EXPECT_EQ(highest_code(s), 200u);
  s.high = 9.92;
  EXPECT_EQ(highest_code(s), 199u);
  EXPECT_EQ(highest_code(signal("w", 32)), 0xFFFFFFFFu);
  EXPECT_EQ(to_physical(signal("w", 32), 0xFFFFFFFFu), 4294967295.0);
}

TEST(PduCodecDeathTest, NotANumberAndWrongSizesAreOurBugs) {
  const schedules::model::PduLayout layout = bus::list_layout();
  std::vector<std::byte> payload(static_cast<std::size_t>(layout.fragment_bytes) + 1);
  EXPECT_DEATH(to_raw(layout.element[0], std::numeric_limits<double>::quiet_NaN()), "not a number");
  EXPECT_DEATH(read_header_raw(layout, payload, 0), "bytes for list");
  EXPECT_DEATH(read_element_raw(layout, std::span(payload).first(payload.size() - 1), 3, 0), "element 3");
}

}  // namespace
}  // namespace ttf::bus::wire
