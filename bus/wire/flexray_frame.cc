#include "bus/wire/flexray_frame.h"

#include <algorithm>

#include "bus/wire/flexray_crc.h"
#include "core/check.h"

namespace ttf::bus::wire {
namespace {

// Positions of the fields in the header's 40 bits, counted from the last bit (flexray_frame.h draws them).
constexpr int kPreambleBit = 38, kNullBit = 37, kSyncBit = 36, kStartupBit = 35, kFrameIdBit = 24,
              kPayloadWordsBit = 17, kHeaderCrcBit = 6;

std::uint32_t trailer_of(std::span<const std::byte> frame) {
  std::uint32_t trailer = 0;
  for (const std::byte byte : frame.last(kTrailerBytes)) trailer = (trailer << 8) | static_cast<std::uint32_t>(byte);
  return trailer;
}

}  // namespace

std::size_t encode_frame(const FrameHeader& header, schedules::model::Channel channel,
                         std::span<const std::byte> payload, std::span<std::byte> frame) {
  const std::size_t size = kHeaderBytes + payload.size() + kTrailerBytes;
  TTF_CHECK(payload.size() % 2 == 0 && payload.size() <= kMaxPayloadBytes && frame.size() >= size,
            "payload {} bytes, room {}", payload.size(), frame.size());
  TTF_CHECK(header.frame_id >= 1 && header.frame_id <= 2047 && header.cycle <= 63, "frame id {} cycle {}",
            header.frame_id, header.cycle);
  TTF_CHECK(header.sync || !header.startup, "a startup frame is a sync frame");
  TTF_CHECK(!header.null_frame || !header.payload_preamble, "a null frame has no payload preamble");
  const auto words = static_cast<std::uint8_t>(payload.size() / 2);
  const std::uint64_t crc = header_crc(header.sync, header.startup, header.frame_id, words);
  const auto bit = [](bool set, int at) { return static_cast<std::uint64_t>(set) << at; };
  const std::uint64_t bits =
      bit(header.payload_preamble, kPreambleBit) | bit(!header.null_frame, kNullBit) | bit(header.sync, kSyncBit) |
      bit(header.startup, kStartupBit) | (static_cast<std::uint64_t>(header.frame_id) << kFrameIdBit) |
      (static_cast<std::uint64_t>(words) << kPayloadWordsBit) | (crc << kHeaderCrcBit) | header.cycle;
  for (std::size_t i = 0; i < kHeaderBytes; ++i) frame[i] = static_cast<std::byte>((bits >> (8 * (4 - i))) & 0xFF);
  std::copy(payload.begin(), payload.end(), frame.begin() + kHeaderBytes);
  const std::uint32_t trailer = frame_crc(channel, frame.first(kHeaderBytes + payload.size()));
  for (std::size_t i = 0; i < kTrailerBytes; ++i)
    frame[kHeaderBytes + payload.size() + i] = static_cast<std::byte>((trailer >> (8 * (2 - i))) & 0xFF);
  return size;
}

FrameHeader parse_header(std::span<const std::byte, kHeaderBytes> header) {
  std::uint64_t bits = 0;
  for (const std::byte byte : header) bits = (bits << 8) | static_cast<std::uint64_t>(byte);
  FrameHeader parsed;
  parsed.payload_preamble = (bits >> kPreambleBit) & 1;
  parsed.null_frame = !((bits >> kNullBit) & 1);
  parsed.sync = (bits >> kSyncBit) & 1;
  parsed.startup = (bits >> kStartupBit) & 1;
  parsed.frame_id = static_cast<std::uint16_t>((bits >> kFrameIdBit) & 0x7FF);
  parsed.payload_words = static_cast<std::uint8_t>((bits >> kPayloadWordsBit) & 0x7F);
  parsed.header_crc = static_cast<std::uint16_t>((bits >> kHeaderCrcBit) & 0x7FF);
  parsed.cycle = static_cast<std::uint8_t>(bits & 0x3F);
  return parsed;
}

std::optional<FrameHeader> header_of(std::span<const std::byte> frame) {
  if (frame.size() < kHeaderBytes) return std::nullopt;
  return parse_header(frame.first<kHeaderBytes>());
}

bool header_crc_holds(const FrameHeader& header) {
  return header_crc(header.sync, header.startup, header.frame_id, header.payload_words) == header.header_crc;
}

DecodedFrame decode_frame(schedules::model::Channel channel, std::span<const std::byte> frame) {
  DecodedFrame decoded;
  if (frame.size() < kHeaderBytes + kTrailerBytes) {
    decoded.error = FrameError::kTooShort;
    return decoded;
  }
  decoded.header = parse_header(frame.first<kHeaderBytes>());
  const FrameHeader& header = decoded.header;
  const std::size_t payload = frame.size() - kHeaderBytes - kTrailerBytes;
  if (!header_crc_holds(header))
    decoded.error = FrameError::kHeaderCrc;
  else if (payload != std::size_t{2} * header.payload_words)
    decoded.error = FrameError::kLength;
  else if (frame_crc(channel, frame.first(kHeaderBytes + payload)) != trailer_of(frame))
    decoded.error = FrameError::kFrameCrc;
  else if (header.frame_id == 0)
    decoded.error = FrameError::kReservedId;
  else if (header.null_frame && header.payload_preamble)
    decoded.error = FrameError::kNullPreamble;
  decoded.payload = frame.subspan(kHeaderBytes, payload);
  return decoded;
}

FrameCrcs check_crcs(schedules::model::Channel channel, std::span<const std::byte> frame) {
  const std::optional<FrameHeader> header = header_of(frame);
  if (!header) return {};
  FrameCrcs crcs;
  crcs.header_holds = header_crc_holds(*header);
  const std::size_t until_trailer = kHeaderBytes + std::size_t{2} * header->payload_words;
  if (frame.size() == until_trailer + kTrailerBytes)
    crcs.frame_holds = frame_crc(channel, frame.first(until_trailer)) == trailer_of(frame);
  return crcs;
}

bool has_header(const DecodedFrame& frame) {
  return frame.error != FrameError::kTooShort && frame.error != FrameError::kHeaderCrc;
}

std::optional<std::uint16_t> message_id(const DecodedFrame& frame) {
  if (!frame.header.payload_preamble || frame.payload.size() < schedules::model::kMessageIdBytes) return std::nullopt;
  return static_cast<std::uint16_t>(static_cast<unsigned>(frame.payload[0]) << 8 |
                                    static_cast<unsigned>(frame.payload[1]));
}

std::int64_t frame_duration_ps(const schedules::model::GlobalParameters& flexray, int payload_words) {
  return schedules::model::frame_bits(flexray, payload_words) * flexray.gdBit_ps;
}

Duration frame_duration(const schedules::model::GlobalParameters& flexray, int payload_words) {
  return {(frame_duration_ps(flexray, payload_words) + 999) / 1000};
}

}  // namespace ttf::bus::wire
