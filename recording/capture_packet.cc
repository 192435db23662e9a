#include "recording/capture_packet.h"

#include <algorithm>
#include <array>

#include "bus/wire/flexray_crc.h"

namespace ttf::recording {
namespace {

constexpr std::uint8_t kChannelB = 0x80, kTypeMask = 0x7f;
constexpr std::size_t kFlexRayPrefix = 2;

void put_byte(std::string& out, std::uint32_t value) { out.push_back(static_cast<char>(value & 0xff)); }

void put_bytes(std::string& out, std::span<const std::byte> bytes) {
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

bool header_crc_holds(const wire::FrameHeader& h) {
  return wire::header_crc(h.sync, h.startup, h.frame_id, h.payload_words) == h.header_crc;
}

// Fields of a header that may belong to no valid frame.
wire::FrameHeader header_of(std::span<const std::byte> bytes) {
  std::array<std::byte, wire::kHeaderBytes + wire::kTrailerBytes> alone{};
  std::copy_n(bytes.begin(), wire::kHeaderBytes, alone.begin());
  return wire::decode_frame(schedules::Channel::kA, alone).header;
}

}  // namespace

CheckedFlexRayFrame check_flexray_frame(schedules::Channel channel, std::span<const std::byte> bytes) {
  CheckedFlexRayFrame frame;
  if (bytes.size() < wire::kHeaderBytes + wire::kTrailerBytes) {
    frame.header_and_payload = bytes.first(std::min(bytes.size(), wire::kHeaderBytes));
    frame.errors = kFrameCrcError;
  } else {
    frame.header_and_payload =
        bytes.first(std::min(bytes.size() - wire::kTrailerBytes, wire::kHeaderBytes + wire::kMaxPayloadBytes));
  }
  if (frame.header_and_payload.size() < wire::kHeaderBytes) {
    frame.errors |= kHeaderCrcError;
    return frame;
  }
  frame.header = header_of(frame.header_and_payload);
  if (!header_crc_holds(frame.header)) frame.errors |= kHeaderCrcError;
  const std::size_t size = wire::kHeaderBytes + std::size_t{2} * frame.header.payload_words + wire::kTrailerBytes;
  if (bytes.size() != size) {
    frame.errors |= kFrameCrcError;
    return frame;
  }
  std::uint32_t trailer = 0;
  for (const std::byte byte : bytes.last(wire::kTrailerBytes))
    trailer = (trailer << 8) | static_cast<std::uint32_t>(byte);
  if (wire::frame_crc(channel, frame.header_and_payload) != trailer) frame.errors |= kFrameCrcError;
  return frame;
}

void put_flexray_packet(std::string& out, schedules::Channel channel, const CheckedFlexRayFrame& frame) {
  put_byte(out,
           (channel == schedules::Channel::kB ? kChannelB : 0u) | static_cast<unsigned>(FlexRayPacket::Kind::kFrame));
  put_byte(out, frame.errors);
  put_bytes(out, frame.header_and_payload);
}

FlexRayPacket parse_flexray_packet(std::span<const std::byte> data) {
  FlexRayPacket packet;
  if (data.size() < kFlexRayPrefix) return packet;
  const auto first = static_cast<std::uint8_t>(data[0]);
  packet.channel = (first & kChannelB) != 0 ? schedules::Channel::kB : schedules::Channel::kA;
  switch (first & kTypeMask) {
    case static_cast<int>(FlexRayPacket::Kind::kFrame):
      packet.kind = FlexRayPacket::Kind::kFrame;
      break;
    case static_cast<int>(FlexRayPacket::Kind::kSymbol):
      packet.kind = FlexRayPacket::Kind::kSymbol;
      packet.symbol_bits = static_cast<int>(data[1]) & 0x7f;
      return packet;
    default:
      return packet;
  }
  packet.errors = static_cast<std::uint8_t>(data[1]) & 0x1f;
  const std::span<const std::byte> frame = data.subspan(kFlexRayPrefix);
  if (frame.size() < wire::kHeaderBytes) return packet;
  packet.whole_header = true;
  packet.header = header_of(frame);
  packet.header_crc_holds = header_crc_holds(packet.header);
  packet.payload = frame.subspan(wire::kHeaderBytes);
  return packet;
}

void put_can_packet(std::string& out, std::uint32_t identifier, bool flexible_data_rate,
                    std::span<const std::byte> data) {
  const std::span<const std::byte> kept = data.first(std::min(data.size(), kMaxCanData));
  if (identifier > kLargestBaseIdentifier) identifier |= kExtendedIdentifier;
  for (const int shift : {24, 16, 8, 0}) put_byte(out, identifier >> shift);
  put_byte(out, static_cast<std::uint32_t>(kept.size()));
  put_byte(out, flexible_data_rate ? kBitRateSwitch | kFlexibleDataRate : 0u);
  put_byte(out, 0);
  put_byte(out, 0);
  put_bytes(out, kept);
}

}  // namespace ttf::recording
