// Frames bit by bit: against sequences written by hand, against the durations of bus/wire/can_timing.h, and back
// through the decoder.
#include "bus/can/frame_bits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bus/can/decoder.h"
#include "bus/wire/can_timing.h"
#include "core/random.h"
#include "tests/bus/can/by_hand.h"

namespace ttf::bus::can {
namespace {

std::string text_of(const FrameBits& frame) {
  std::string text;
  for (std::size_t b = 0; b < frame.size(); ++b) text += frame[b].recessive ? '1' : '0';
  return text;
}
std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> all;
  for (const int value : values) all.push_back(static_cast<std::byte>(value));
  return all;
}
std::vector<std::byte> drawn(RandomStream& stream, int length) {
  const bool plain = stream.uniform() < 0.5;  // else long runs of equal bits
  std::vector<std::byte> data(static_cast<std::size_t>(length));
  for (std::byte& byte : data)
    byte = static_cast<std::byte>(
        plain ? stream.integer(0, 255)
              : std::array{0x00, 0xFF, 0x0F, 0xF8, 0x1F}[static_cast<std::size_t>(stream.integer(0, 4))]);
  return data;
}

// The fields are those of the standard, in its order. The CRC of 15 bits was divided on paper.
TEST(FrameBits, ClassicFramesByHand) {
  EXPECT_EQ(text_of({false, 0x555, bytes({0x55})}),
            joined("0 10101010101 000 00[1]01 01010101 1111[0]00010010111 1 1 1 1111111"));
  EXPECT_EQ(text_of({false, 0x014, bytes({0x01})}),
            joined("0 0000[1]0010100 000[1] 0001 00000[1]001 111011101010011 1 1 1 1111111"));
  EXPECT_EQ(text_of({false, 0x7FF, bytes({0xFF, 0xFF})}),
            joined("0 11111[0]11111[0]1 000 00[1]10 11111[0]111 11[0]11111[0]1 011111[0]110010000 1 1 1 1111111"));
}

// With bit-rate switching: RRS IDE FDF res BRS, then ESI, length, data, and with fixed stuff bits the stuff count 0 with
// its parity and the CRC of 17 bits.
TEST(FrameBits, AFlexibleDataRateFrameByHand) {
  const FrameBits frame(true, 0x555, bytes({0x55}));
  const std::string text = text_of(frame);
  EXPECT_EQ(text.substr(0, 36), joined("0 10101010101 00101 0 0001 01010101 [0]0000 [1]").substr(0, 36));
  EXPECT_EQ(frame.size(), 17u + 5 + 8 + 27 + 10);
  EXPECT_EQ(text_of({true, 0x555, bytes({0x55}), true}).substr(0, 22),
            joined("0 10101010101 00101 1 0001"));  // passive
}

TEST(FrameBits, HaveTheDurationsOfTheirFrames) {
  RandomStream stream({13, 0, Purpose::kTest, 1, 0});
  schedules::model::CanBus bus;
  bus.name = "can";
  bus.nominal_bit_rate = bus.data_bit_rate = 1'000'000;  // a nanosecond's worth of each bit, whatever its rate
  for (int run = 0; run < 20'000; ++run) {
    bus.flexible_data_rate = run % 2 == 0;
    const auto data = drawn(stream, kDataLengths[static_cast<std::size_t>(stream.integer(0, run % 2 == 0 ? 15 : 8))]);
    const auto id = static_cast<std::uint32_t>(stream.integer(0, 2047));
    const FrameBits frame(bus.flexible_data_rate, id, data);
    ASSERT_EQ(wire::can_frame_duration(bus, id, data),
              Duration::microseconds(static_cast<std::int64_t>(frame.size()) + 3));
  }
}

// The decoder's verdict on bits, with the acknowledgement as a receiver gives it.
struct Received {
  CanError error = CanError::kNone;
  std::size_t at = 0;  // the bit of the error, or of the acceptance
  bool accepted = false;
};
Received receive(Decoder& decoder, bool flexible_data_rate, const FrameBits& frame, std::size_t inverted = 9'999) {
  decoder.begin(flexible_data_rate);
  for (std::size_t b = 0; b < frame.size(); ++b) {
    const bool level = frame[b].acknowledgement ? !decoder.acknowledges() : frame[b].recessive;
    const Decoder::Taken taken = decoder.take(level != (b == inverted));
    if (taken.error != CanError::kNone) return {taken.error, b, false};
    if (taken.accepted) return {CanError::kNone, b, true};
  }
  return {};
}

TEST(Decoder, ReadsWhatWasSent) {
  RandomStream stream({13, 0, Purpose::kTest, 2, 0});
  Decoder decoder;
  for (int run = 0; run < 20'000; ++run) {
    const bool flexible = run % 2 == 0;
    const auto data = drawn(stream, kDataLengths[static_cast<std::size_t>(stream.integer(0, flexible ? 15 : 8))]);
    const auto id = static_cast<std::uint32_t>(stream.integer(0, 2047));
    const FrameBits frame(flexible, id, data, run % 3 == 0);
    const Received received = receive(decoder, flexible, frame);
    ASSERT_TRUE(received.accepted) << run << " error " << static_cast<int>(received.error) << " at " << received.at;
    ASSERT_EQ(received.at, frame.size() - 2);  // the last but one bit of the end of frame
    ASSERT_EQ(decoder.identifier(), id);
    ASSERT_TRUE(std::equal(data.begin(), data.end(), decoder.data().begin(), decoder.data().end()));
  }
}

// A single inverted bit never passes; behind the CRC it is an error of form.
TEST(Decoder, RefusesEveryInvertedBit) {
  RandomStream stream({13, 0, Purpose::kTest, 3, 0});
  Decoder decoder;
  for (int run = 0; run < 60; ++run) {
    const bool flexible = run % 2 == 0;
    const auto data = drawn(stream, flexible ? kDataLengths[static_cast<std::size_t>(run / 4)] : run % 9);
    const FrameBits frame(flexible, static_cast<std::uint32_t>(stream.integer(0, 2047)), data);
    for (std::size_t bit = 1; bit + 1 < frame.size(); ++bit) {
      if (frame[bit].acknowledgement || (!flexible && bit == 15 && frame[bit].stuff)) continue;
      const Received received = receive(decoder, flexible, frame, bit);
      ASSERT_FALSE(received.accepted) << run << " bit " << bit;
      ASSERT_GE(received.at, received.error == CanError::kNone ? 0 : bit);
    }
    const std::size_t delimiter = frame.size() - 10;
    for (const std::size_t bit : {delimiter, delimiter + 2, delimiter + 3, delimiter + 8})
      ASSERT_EQ(receive(decoder, flexible, frame, bit).error, CanError::kForm) << bit;
  }
}

}  // namespace
}  // namespace ttf::bus::can
