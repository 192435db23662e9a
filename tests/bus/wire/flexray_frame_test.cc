#include "bus/wire/flexray_frame.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "bus/wire/flexray_crc.h"
#include "core/random.h"

namespace ttf::bus::wire {
namespace {

using schedules::model::Channel;
using Bytes = std::vector<std::byte>;

Bytes bytes_of(std::initializer_list<unsigned> values) {
  Bytes bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

Bytes counting(std::size_t size) {
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(i));
  return bytes;
}

// The oracle: bitwise polynomial division over a list of bits, independent of the code under test.
std::uint32_t divide(const std::vector<bool>& bits, int width, std::uint32_t polynomial, std::uint32_t start) {
  std::uint64_t shift_register = start;
  for (const bool bit : bits) {
    const bool top = (shift_register >> (width - 1)) & 1u;
    shift_register = (shift_register << 1) & ((std::uint64_t{1} << width) - 1);
    if (top != bit) shift_register ^= polynomial;
  }
  return static_cast<std::uint32_t>(shift_register);
}

void append(std::vector<bool>& bits, std::uint64_t value, int count) {
  for (int b = count - 1; b >= 0; --b) bits.push_back((value >> b) & 1u);
}

std::uint32_t oracle_header_crc(bool sync, bool startup, unsigned id, unsigned words) {
  std::vector<bool> bits{sync, startup};
  append(bits, id, 11);
  append(bits, words, 7);
  return divide(bits, 11, 0x385, 0x01A);
}

std::uint32_t oracle_frame_crc(Channel channel, std::span<const std::byte> bytes) {
  std::vector<bool> bits;
  for (const std::byte byte : bytes) append(bits, static_cast<unsigned>(byte), 8);
  return divide(bits, 24, 0x5D6DCB, channel == Channel::kA ? 0xFEDCBA : 0xABCDEF);
}

Bytes encoded(const FrameHeader& header, Channel channel, const Bytes& payload) {
  Bytes frame(kMaxFrameBytes);
  frame.resize(encode_frame(header, channel, payload, frame));
  return frame;
}

TEST(HeaderCrc, KnownVectors) {
  EXPECT_EQ(header_crc(false, false, 9, 16), 0x3FC);  // Freescale MC9S12XF, the manufacturer's example for slot 9
  EXPECT_EQ(header_crc(true, true, 1, 8), 0x11B);
  EXPECT_EQ(header_crc(true, true, 7, 16), 0x4CC);
  EXPECT_EQ(header_crc(true, true, 9, 16), 0x4DF);
  EXPECT_EQ(header_crc(false, false, 5, 8), 0x1EC);
  EXPECT_EQ(header_crc(false, false, 2047, 127), 0x135);
}

// The catalogue's check value is over 72 bits, which a header never has: it checks the oracle's parameters.
TEST(HeaderCrc, OracleHasTheCataloguesParameters) {
  std::vector<bool> bits;
  for (const char c : std::string_view("123456789")) append(bits, static_cast<unsigned char>(c), 8);
  EXPECT_EQ(divide(bits, 11, 0x385, 0x01A), 0x5A3u);
}

TEST(HeaderCrc, AgreesWithBitwiseDivisionEverywhere) {
  for (unsigned id = 1; id <= 2047; ++id)
    for (unsigned words = 0; words <= 127; words += 1 + id % 3)
      for (const bool sync : {false, true})
        for (const bool startup : {false, true})
          ASSERT_EQ(header_crc(sync, startup, static_cast<std::uint16_t>(id), static_cast<std::uint8_t>(words)),
                    oracle_header_crc(sync, startup, id, words))
              << id << " " << words;
}

TEST(FrameCrc, CatalogueCheckValues) {
  Bytes digits;
  for (const char c : std::string_view("123456789")) digits.push_back(static_cast<std::byte>(c));
  EXPECT_EQ(frame_crc(Channel::kA, digits), 0x7979BDu);
  EXPECT_EQ(frame_crc(Channel::kB, digits), 0x1F23B8u);
}

TEST(FrameCrc, AgreesWithBitwiseDivision) {
  RandomStream stream({4, 0, Purpose::kTest, 1, 0});
  for (int run = 0; run < 500; ++run) {
    Bytes bytes(static_cast<std::size_t>(stream.integer(0, 259)));
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(stream.integer(0, 255));
    for (const Channel channel : {Channel::kA, Channel::kB})
      ASSERT_EQ(frame_crc(channel, bytes), oracle_frame_crc(channel, bytes));
  }
}

TEST(Frame, KnownFrames) {
  FrameHeader header;
  header.sync = header.startup = true;
  header.frame_id = 1;
  const Bytes a = encoded(header, Channel::kA, counting(16)), b = encoded(header, Channel::kB, counting(16));
  Bytes expected = bytes_of({0x38, 0x01, 0x10, 0x46, 0xC0});
  const Bytes payload = counting(16);
  expected.insert(expected.end(), payload.begin(), payload.end());
  Bytes expected_b = expected;
  for (const unsigned byte : {0x57u, 0x84u, 0xC3u}) expected.push_back(static_cast<std::byte>(byte));
  for (const unsigned byte : {0x45u, 0xC9u, 0x33u}) expected_b.push_back(static_cast<std::byte>(byte));
  EXPECT_EQ(a, expected);
  EXPECT_EQ(b, expected_b);
}

TEST(Frame, KnownNullFrame) {
  FrameHeader header;
  header.null_frame = true;
  header.frame_id = 5;
  header.cycle = 1;
  EXPECT_EQ(encoded(header, Channel::kA, {}), bytes_of({0x00, 0x05, 0x00, 0x52, 0xC1, 0xF4, 0x0E, 0xD3}));
  EXPECT_EQ(encoded(header, Channel::kB, {}), bytes_of({0x00, 0x05, 0x00, 0x52, 0xC1, 0x1F, 0x80, 0xB6}));
}

TEST(Frame, EveryHeaderFieldGoesRoundTrip) {
  RandomStream stream({4, 0, Purpose::kTest, 2, 0});
  for (int run = 0; run < 5000; ++run) {
    FrameHeader header;
    header.null_frame = stream.integer(0, 1) == 1;
    header.payload_preamble = !header.null_frame && stream.integer(0, 1) == 1;
    header.sync = stream.integer(0, 1) == 1;
    header.startup = header.sync && stream.integer(0, 1) == 1;
    header.frame_id = static_cast<std::uint16_t>(stream.integer(1, 2047));
    header.cycle = static_cast<std::uint8_t>(stream.integer(0, 63));
    Bytes payload(static_cast<std::size_t>(2 * stream.integer(0, 127)));
    for (std::byte& byte : payload) byte = static_cast<std::byte>(stream.integer(0, 255));
    const Channel channel = run % 2 == 0 ? Channel::kA : Channel::kB;
    const Bytes frame = encoded(header, channel, payload);
    const DecodedFrame decoded = decode_frame(channel, frame);
    ASSERT_EQ(decoded.error, FrameError::kNone);
    ASSERT_EQ(decoded.header.payload_preamble, header.payload_preamble);
    ASSERT_EQ(decoded.header.null_frame, header.null_frame);
    ASSERT_EQ(decoded.header.sync, header.sync);
    ASSERT_EQ(decoded.header.startup, header.startup);
    ASSERT_EQ(decoded.header.frame_id, header.frame_id);
    ASSERT_EQ(decoded.header.payload_words, payload.size() / 2);
    ASSERT_EQ(decoded.header.cycle, header.cycle);
    ASSERT_EQ(decoded.header.header_crc,
              oracle_header_crc(header.sync, header.startup, header.frame_id, decoded.header.payload_words));
    ASSERT_EQ(Bytes(decoded.payload.begin(), decoded.payload.end()), payload);
  }
}

// Decoded bit by bit after the specification's drawing (4.2), with and without trailing bytes.
TEST(Frame, AHeaderIsReadWhateverItsCrcSays) {
  RandomStream stream({4, 0, Purpose::kTest, 2, 0});
  int holding = 0;
  for (int run = 0; run < 20'000; ++run) {
    Bytes bytes(kHeaderBytes);
    std::vector<bool> bits;
    for (std::byte& byte : bytes) {
      byte = static_cast<std::byte>(stream.integer(0, 255));
      append(bits, static_cast<unsigned>(byte), 8);
    }
    const auto field = [&bits](std::size_t from, std::size_t count) {
      unsigned value = 0;
      for (std::size_t b = from; b < from + count; ++b) value = value << 1 | unsigned{bits[b]};
      return value;
    };
    for (const std::size_t more : {0u, 3u, 40u}) {
      bytes.resize(kHeaderBytes + more);
      const auto header = header_of(bytes);
      ASSERT_TRUE(header);
      ASSERT_EQ(header->payload_preamble, field(1, 1) == 1);
      ASSERT_EQ(header->null_frame, field(2, 1) == 0);
      ASSERT_EQ(header->sync, field(3, 1) == 1);
      ASSERT_EQ(header->startup, field(4, 1) == 1);
      ASSERT_EQ(header->frame_id, field(5, 11));
      ASSERT_EQ(header->payload_words, field(16, 7));
      ASSERT_EQ(header->header_crc, field(23, 11));
      ASSERT_EQ(header->cycle, field(34, 6));
      const bool holds =
          oracle_header_crc(field(3, 1) == 1, field(4, 1) == 1, field(5, 11), field(16, 7)) == field(23, 11);
      ASSERT_EQ(header_crc_holds(*header), holds);
      ASSERT_EQ(check_crcs(Channel::kA, bytes).header_holds, holds);
      holding += holds ? 1 : 0;
    }
  }
  EXPECT_GT(holding, 0);
  for (std::size_t size = 0; size < kHeaderBytes; ++size) EXPECT_FALSE(header_of(Bytes(size))) << size;
}

TEST(Frame, AFrameThatCrossedTheChannelsIsDetected) {
  FrameHeader header;
  header.frame_id = 12;
  for (const std::size_t size : {0u, 2u, 56u, 254u}) {
    EXPECT_EQ(decode_frame(Channel::kB, encoded(header, Channel::kA, counting(size))).error, FrameError::kFrameCrc);
    EXPECT_EQ(decode_frame(Channel::kA, encoded(header, Channel::kB, counting(size))).error, FrameError::kFrameCrc);
  }
}

// Hamming distance 6: up to five wrong bits are always found. This flips all single bits and pairs of a short
// frame.
TEST(Frame, EveryOneOrTwoWrongBitsAreDetected) {
  FrameHeader header;
  header.sync = true;
  header.frame_id = 345;
  header.cycle = 17;
  Bytes frame = encoded(header, Channel::kA, counting(8));
  const std::size_t bits = 8 * frame.size();
  const auto flip = [&](std::size_t bit) { frame[bit / 8] ^= static_cast<std::byte>(0x80u >> (bit % 8)); };
  for (std::size_t one = 0; one < bits; ++one) {
    flip(one);
    ASSERT_NE(decode_frame(Channel::kA, frame).error, FrameError::kNone) << one;
    for (std::size_t two = one + 1; two < bits; ++two) {
      flip(two);
      ASSERT_NE(decode_frame(Channel::kA, frame).error, FrameError::kNone) << one << " " << two;
      flip(two);
    }
    flip(one);
  }
  EXPECT_EQ(decode_frame(Channel::kA, frame).error, FrameError::kNone);
}

TEST(Frame, EachErrorHasItsName) {
  FrameHeader header;
  header.frame_id = 7;
  const Bytes good = encoded(header, Channel::kA, counting(8));
  EXPECT_EQ(decode_frame(Channel::kA, std::span(good).first(7)).error, FrameError::kTooShort);
  EXPECT_EQ(decode_frame(Channel::kA, {}).error, FrameError::kTooShort);
  EXPECT_EQ(decode_frame(Channel::kA, std::span(good).first(good.size() - 2)).error, FrameError::kLength);
  Bytes longer = good;
  longer.push_back(std::byte{0});
  EXPECT_EQ(decode_frame(Channel::kA, longer).error, FrameError::kLength);
  Bytes header_wrong = good;
  header_wrong[1] ^= std::byte{1};
  EXPECT_EQ(decode_frame(Channel::kA, header_wrong).error, FrameError::kHeaderCrc);
  Bytes payload_wrong = good;
  payload_wrong[6] ^= std::byte{1};
  EXPECT_EQ(decode_frame(Channel::kA, payload_wrong).error, FrameError::kFrameCrc);

  // Frame id 0 with both CRCs right: written by hand, for encode_frame refuses it.
  const std::uint64_t bits = std::uint64_t{1} << 37 | static_cast<std::uint64_t>(header_crc(false, false, 0, 0)) << 6;
  Bytes reserved;
  for (int byte = 4; byte >= 0; --byte) reserved.push_back(static_cast<std::byte>((bits >> (8 * byte)) & 0xFF));
  const std::uint32_t crc = oracle_frame_crc(Channel::kA, reserved);
  for (int byte = 2; byte >= 0; --byte) reserved.push_back(static_cast<std::byte>((crc >> (8 * byte)) & 0xFF));
  EXPECT_EQ(decode_frame(Channel::kA, reserved).error, FrameError::kReservedId);
}

// The header CRC does not cover the indicators: only the frame CRC has to be corrected.
TEST(Frame, ANullFrameHasNoPayloadPreamble) {
  FrameHeader header;
  header.frame_id = 7;
  header.payload_preamble = true;
  Bytes frame = encoded(header, Channel::kB, counting(8));
  EXPECT_EQ(decode_frame(Channel::kB, frame).error, FrameError::kNone);
  frame[0] &= ~std::byte{0x20};  // null frame, inverted on the wire
  const auto covered = std::span(frame).first(frame.size() - kTrailerBytes);
  const std::uint32_t crc = oracle_frame_crc(Channel::kB, covered);
  for (std::size_t byte = 0; byte < 3; ++byte)
    frame[covered.size() + byte] = static_cast<std::byte>((crc >> (8 * (2 - byte))) & 0xFF);
  const DecodedFrame decoded = decode_frame(Channel::kB, frame);
  EXPECT_EQ(decoded.error, FrameError::kNullPreamble);
  EXPECT_TRUE(decoded.header.null_frame && decoded.header.payload_preamble);
}

TEST(FrameDeathTest, FramesNobodyMaySendAreOurBugs) {
  Bytes frame(kMaxFrameBytes);
  FrameHeader header;
  header.frame_id = 7;
  header.null_frame = header.payload_preamble = true;
  EXPECT_DEATH(encode_frame(header, Channel::kA, {}, frame), "no payload preamble");
  header.payload_preamble = false;
  header.startup = true;
  EXPECT_DEATH(encode_frame(header, Channel::kA, {}, frame), "a startup frame is a sync frame");
}

// A frame with zero payload has a real CRC too: 000000 in its place is wrong.
TEST(Frame, ZeroIsNoCrc) {
  FrameHeader header;
  header.frame_id = 3;
  Bytes frame = encoded(header, Channel::kA, {});
  std::fill(frame.end() - 3, frame.end(), std::byte{0});
  EXPECT_EQ(decode_frame(Channel::kA, frame).error, FrameError::kFrameCrc);
}

TEST(Frame, LengthOnTheWire) {
  schedules::model::GlobalParameters flexray;
  flexray.gdTSSTransmitter = 9;
  flexray.gdBit_ps = 100'000;
  EXPECT_EQ(frame_bits(flexray, 28), 9 + 1 + 80 + 560 + 2);
  EXPECT_EQ(frame_duration_ps(flexray, 28), 65'200'000);
  EXPECT_EQ(frame_duration(flexray, 28), Duration{65'200});
  EXPECT_EQ(words_in_frame(kHeaderBytes + 56 + kTrailerBytes), 28);
  flexray.gdBit_ps = 12'345;  // no bit rate of the standard, but one that does not end on a whole nanosecond
  EXPECT_EQ(frame_duration_ps(flexray, 28), 652 * 12'345);
  EXPECT_EQ(frame_duration(flexray, 28), Duration{8'049}) << "8048.94 ns";
  EXPECT_EQ(frame_bits(flexray, 127), 9 + 1 + 80 + 2540 + 2);
}

}  // namespace
}  // namespace ttf::bus::wire
