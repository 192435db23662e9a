#include "recording/capture/packet.h"

#include <algorithm>
#include <optional>

namespace ttf::recording::capture {
namespace {

constexpr std::uint8_t kChannelB = 0x80, kTypeMask = 0x7f;
constexpr std::size_t kFlexRayPrefix = 2;

void put_byte(std::string& out, std::uint32_t value) { out.push_back(static_cast<char>(value & 0xff)); }

void put_prefix(std::string& out, schedules::model::Channel channel, FlexRayPacket::Kind kind) {
  put_byte(out, (channel == schedules::model::Channel::kB ? kChannelB : 0u) | static_cast<unsigned>(kind));
}

void put_bytes(std::string& out, std::span<const std::byte> bytes) {
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace

CheckedFlexRayFrame check_flexray_frame(schedules::model::Channel channel, std::span<const std::byte> bytes) {
  CheckedFlexRayFrame frame;
  const bus::wire::FrameCrcs crcs = bus::wire::check_crcs(channel, bytes);
  if (!crcs.header_holds) frame.errors |= kHeaderCrcError;
  if (!crcs.frame_holds) frame.errors |= kFrameCrcError;
  frame.header = bus::wire::header_of(bytes).value_or(bus::wire::FrameHeader{});
  const bool trailer = bytes.size() >= bus::wire::kHeaderBytes + bus::wire::kTrailerBytes;
  frame.header_and_payload = trailer ? bytes.first(std::min(bytes.size() - bus::wire::kTrailerBytes,
                                                            bus::wire::kHeaderBytes + bus::wire::kMaxPayloadBytes))
                                     : bytes.first(std::min(bytes.size(), bus::wire::kHeaderBytes));
  return frame;
}

CheckedFlexRayFrame check_broken_frame(schedules::model::Channel channel, std::span<const std::byte> bytes) {
  CheckedFlexRayFrame frame;
  frame.header_and_payload = bytes.first(std::min(bytes.size(), bus::wire::kHeaderBytes + bus::wire::kMaxPayloadBytes));
  const std::optional<bus::wire::FrameHeader> header = bus::wire::header_of(bytes);
  if (!header) return frame;
  frame.header = *header;
  const bus::wire::FrameCrcs crcs = bus::wire::check_crcs(channel, bytes);
  if (!crcs.header_holds) frame.errors |= kHeaderCrcError;
  const std::size_t until_trailer = bus::wire::kHeaderBytes + std::size_t{2} * header->payload_words;
  if (bytes.size() == until_trailer + bus::wire::kTrailerBytes && !crcs.frame_holds) frame.errors |= kFrameCrcError;
  // Without a sound header the end of the payload is unknown.
  if (crcs.header_holds) frame.header_and_payload = bytes.first(std::min(bytes.size(), until_trailer));
  return frame;
}

void put_flexray_packet(std::string& out, schedules::model::Channel channel, const CheckedFlexRayFrame& frame) {
  put_prefix(out, channel, FlexRayPacket::Kind::kFrame);
  put_byte(out, frame.errors);
  put_bytes(out, frame.header_and_payload);
}

void put_symbol_packet(std::string& out, schedules::model::Channel channel, std::int64_t bits) {
  put_prefix(out, channel, FlexRayPacket::Kind::kSymbol);
  put_byte(out, static_cast<std::uint32_t>(std::clamp<std::int64_t>(bits, 0, kLongestSymbolBits)));
}

FlexRayPacket parse_flexray_packet(std::span<const std::byte> data) {
  FlexRayPacket packet;
  if (data.size() < kFlexRayPrefix) return packet;
  const auto first = static_cast<std::uint8_t>(data[0]);
  packet.channel = (first & kChannelB) != 0 ? schedules::model::Channel::kB : schedules::model::Channel::kA;
  switch (first & kTypeMask) {
    case static_cast<int>(FlexRayPacket::Kind::kFrame): packet.kind = FlexRayPacket::Kind::kFrame; break;
    case static_cast<int>(FlexRayPacket::Kind::kSymbol):
      packet.kind = FlexRayPacket::Kind::kSymbol;
      packet.symbol_bits = static_cast<int>(data[1]) & 0x7f;
      return packet;
    default: return packet;
  }
  packet.errors = static_cast<std::uint8_t>(data[1]) & 0x1f;
  const std::span<const std::byte> frame = data.subspan(kFlexRayPrefix);
  const std::optional<bus::wire::FrameHeader> header = bus::wire::header_of(frame);
  if (!header) return packet;
  packet.whole_header = true;
  packet.header = *header;
  packet.header_crc_holds = bus::wire::header_crc_holds(*header);
  packet.payload = frame.subspan(bus::wire::kHeaderBytes);
  return packet;
}

void put_can_packet(std::string& out, std::uint32_t identifier, bool flexible_data_rate,
                    std::span<const std::byte> data) {
  const std::span<const std::byte> kept = data.first(std::min(data.size(), kMaxCanData));
  if (identifier > kLargestBaseIdentifier && (identifier & kErrorFrame) == 0) identifier |= kExtendedIdentifier;
  for (const int shift : {24, 16, 8, 0}) put_byte(out, identifier >> shift);
  put_byte(out, static_cast<std::uint32_t>(kept.size()));
  put_byte(out, flexible_data_rate ? kBitRateSwitch | kFlexibleDataRate : 0u);
  put_byte(out, 0);
  put_byte(out, 0);
  put_bytes(out, kept);
}

}  // namespace ttf::recording::capture
