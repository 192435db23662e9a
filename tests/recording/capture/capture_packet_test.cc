// Packets of link types 210 and 227, byte by byte.
#include <gtest/gtest.h>

#include "tests/recording/capture_fixture.h"

namespace ttf::recording::capture {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// Header 38 01 10 46 c0 and payload 00..0f: startup and sync frame 1 of 8 words in cycle 0; trailer of
// channel A.
std::vector<std::byte> known_frame() {
  std::vector<std::byte> bytes = bytes_of({0x38, 0x01, 0x10, 0x46, 0xc0});
  for (int i = 0; i < 16; ++i) bytes.push_back(static_cast<std::byte>(i));
  for (const int i : {0x57, 0x84, 0xc3}) bytes.push_back(static_cast<std::byte>(i));
  return bytes;
}

TEST(CapturePacket, AKnownFramePassesBothChecksAndLosesItsTrailer) {
  const std::vector<std::byte> bytes = known_frame();
  std::string packet;
  put_flexray_packet(packet, Channel::kA, check_flexray_frame(Channel::kA, bytes));
  EXPECT_EQ(
      packet,
      std::string("\x01\x00\x38\x01\x10\x46\xc0\x00\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c\x0d\x0e\x0f", 23));
}

TEST(CapturePacket, AFrameThatStraysToTheOtherChannelFailsItsFrameCrc) {
  const std::vector<std::byte> bytes = known_frame();
  std::string packet;
  put_flexray_packet(packet, Channel::kB, check_flexray_frame(Channel::kB, bytes));
  EXPECT_EQ(static_cast<unsigned char>(packet[0]), 0x81);
  EXPECT_EQ(packet[1], kFrameCrcError);
}

TEST(CapturePacket, EveryFlippedBitIsFlaggedByTheChecksThatCoverIt) {
  const std::vector<std::byte> sound = known_frame();
  for (std::size_t bit = 0; bit < sound.size() * 8; ++bit) {
    std::vector<std::byte> bytes = sound;
    bytes[bit / 8] ^= static_cast<std::byte>(0x80 >> bit % 8);
    // Sync, startup, frame id, length (bits 3 to 22) and the header CRC (23 to 33).
    const bool in_header_crc = bit >= 3 && bit <= 33;
    EXPECT_EQ(check_flexray_frame(Channel::kA, bytes).errors, kFrameCrcError | (in_header_crc ? kHeaderCrcError : 0))
        << "bit " << bit;
  }
}

TEST(CapturePacket, FramesCutShortFailWhatCannotBeChecked) {
  const std::vector<std::byte> sound = known_frame();
  for (std::size_t size = 0; size < sound.size(); ++size) {
    const CheckedFlexRayFrame frame = check_flexray_frame(Channel::kA, std::span(sound).first(size));
    EXPECT_EQ(frame.errors, kFrameCrcError | (size < bus::wire::kHeaderBytes ? kHeaderCrcError : 0)) << size;
    EXPECT_LE(frame.header_and_payload.size(), size);
  }
}

TEST(CapturePacket, OfAFrameThatBreaksOffOnlyWhatIsThereIsChecked) {
  const std::vector<std::byte> sound = known_frame();
  for (std::size_t size = 0; size <= sound.size(); ++size) {
    const CheckedFlexRayFrame frame = check_broken_frame(Channel::kA, std::span(sound).first(size));
    EXPECT_EQ(frame.errors, 0) << size;
    EXPECT_EQ(frame.header_and_payload.size(), std::min(size, sound.size() - bus::wire::kTrailerBytes));
    EXPECT_EQ(frame.header.frame_id, size < bus::wire::kHeaderBytes ? 0 : 1);
    std::vector<std::byte> bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < 2) continue;
    bytes[1] ^= std::byte{1};
    const bool whole = size == sound.size();
    EXPECT_EQ(check_broken_frame(Channel::kA, bytes).errors,
              (size < bus::wire::kHeaderBytes ? 0 : kHeaderCrcError) | (whole ? kFrameCrcError : 0));
  }
}

TEST(CapturePacket, AFramePutIntoAPacketIsParsedFromIt) {
  for (const Channel channel : {Channel::kA, Channel::kB})
    for (const int words : {0, 1, 28, 127}) {
      BusFrame frame;
      frame.channel = channel;
      frame.header.frame_id = static_cast<std::uint16_t>(2047 - words);
      frame.header.cycle = static_cast<std::uint8_t>(words % 64);
      frame.header.null_frame = words == 0;
      frame.header.sync = words == 28;
      frame.payload.assign(static_cast<std::size_t>(2 * words), std::byte{0x5a});
      const std::string data = frame.packet();
      const FlexRayPacket packet = parse_flexray_packet(std::as_bytes(std::span(data)));
      ASSERT_EQ(packet.kind, FlexRayPacket::Kind::kFrame);
      EXPECT_EQ(packet.channel, channel);
      EXPECT_EQ(packet.errors, 0);
      ASSERT_TRUE(packet.whole_header);
      EXPECT_TRUE(packet.header_crc_holds);
      EXPECT_EQ(packet.header.frame_id, frame.header.frame_id);
      EXPECT_EQ(packet.header.cycle, frame.header.cycle);
      EXPECT_EQ(packet.header.null_frame, frame.header.null_frame);
      EXPECT_EQ(packet.header.sync, frame.header.sync);
      EXPECT_TRUE(std::ranges::equal(packet.payload, frame.payload));
    }
}

TEST(CapturePacket, ASymbolsLengthEndsAt127Bits) {
  std::string packets;
  for (const std::int64_t bits : {-5, 39, 127, 128, 7920})
    put_symbol_packet(packets, bits == 39 ? Channel::kB : Channel::kA, bits);
  EXPECT_EQ(packets, std::string("\x02\x00\x82\x27\x02\x7f\x02\x7f\x02\x7f", 10));
}

TEST(CapturePacket, SymbolsAndScrapsAreDistinctFromFrames) {
  const FlexRayPacket symbol = parse_flexray_packet(bytes_of({0x82, 0x1e}));
  EXPECT_EQ(symbol.kind, FlexRayPacket::Kind::kSymbol);
  EXPECT_EQ(symbol.channel, Channel::kB);
  EXPECT_EQ(symbol.symbol_bits, 30);
  EXPECT_EQ(parse_flexray_packet(bytes_of({0x05, 0x00})).kind, FlexRayPacket::Kind::kUnknown);
  EXPECT_EQ(parse_flexray_packet(bytes_of({0x01})).kind, FlexRayPacket::Kind::kUnknown);
  EXPECT_FALSE(parse_flexray_packet(bytes_of({0x01, 0x00, 0x38, 0x01, 0x10, 0x46})).whole_header);
}

TEST(CapturePacket, CanPacketsHaveTheirIdentifierInBigEndianAndTheFlagsOfFd) {
  std::string classic, flexible, extended;
  put_can_packet(classic, 0x123, false, bytes_of({0xde, 0xad}));
  put_can_packet(flexible, 0x7ff, true, std::vector<std::byte>(64, std::byte{1}));
  put_can_packet(extended, 0x800, false, {});
  EXPECT_EQ(classic, std::string("\x00\x00\x01\x23\x02\x00\x00\x00\xde\xad", 10));
  EXPECT_EQ(flexible, std::string("\x00\x00\x07\xff\x40\x05\x00\x00", 8) + std::string(64, '\1'));
  EXPECT_EQ(extended, std::string("\x80\x00\x08\x00\x00\x00\x00\x00", 8));
}

}  // namespace
}  // namespace ttf::recording::capture
