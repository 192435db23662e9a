// Any bytes as a FlexRay frame. Laws: every error is a value. An accepted frame equals the encoding of its
// header and payload. No frame of one channel passes on the other.
//
// First byte: channel (bit 0), and whether both CRCs are corrected first (bit 1), since they would stop
// nearly every input.
#include <algorithm>
#include <array>
#include <vector>

#include "bus/wire/flexray_crc.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using bus::wire::kHeaderBytes, bus::wire::kTrailerBytes;

void make_crcs_right(schedules::model::Channel channel, std::vector<std::byte>& frame) {
  if (frame.size() < kHeaderBytes + kTrailerBytes) return;
  const auto header = [&](std::size_t i) { return static_cast<std::uint64_t>(frame[i]); };
  const std::uint64_t bits = header(0) << 32 | header(1) << 24 | header(2) << 16 | header(3) << 8 | header(4);
  const std::uint64_t crc =
      bus::wire::header_crc((bits >> 36) & 1, (bits >> 35) & 1, static_cast<std::uint16_t>((bits >> 24) & 0x7ff),
                            static_cast<std::uint8_t>((bits >> 17) & 0x7f));
  const std::uint64_t right = (bits & ~(std::uint64_t{0x7ff} << 6)) | crc << 6;
  for (std::size_t i = 0; i < kHeaderBytes; ++i) frame[i] = static_cast<std::byte>((right >> (8 * (4 - i))) & 0xff);
  const std::size_t covered = frame.size() - kTrailerBytes;
  const std::uint32_t trailer = bus::wire::frame_crc(channel, std::span(frame).first(covered));
  for (std::size_t i = 0; i < kTrailerBytes; ++i)
    frame[covered + i] = static_cast<std::byte>((trailer >> (8 * (2 - i))) & 0xff);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source source(data, size);
  const auto how = source.take<std::uint8_t>();
  const auto channel = (how & 1) != 0 ? schedules::model::Channel::kB : schedules::model::Channel::kA;
  const auto other = (how & 1) != 0 ? schedules::model::Channel::kA : schedules::model::Channel::kB;
  std::vector<std::byte> frame(source.rest().begin(), source.rest().end());
  if ((how & 2) != 0) make_crcs_right(channel, frame);

  const bus::wire::DecodedFrame decoded = bus::wire::decode_frame(channel, frame);
  TTF_CHECK(decoded.error <= bus::wire::FrameError::kNullPreamble, "error {}", static_cast<int>(decoded.error));
  if (decoded.error != bus::wire::FrameError::kNone) return 0;
  TTF_CHECK(frame.size() <= bus::wire::kMaxFrameBytes && decoded.payload.size() == 2u * decoded.header.payload_words,
            "{} bytes, {} words", frame.size(), decoded.header.payload_words);
  TTF_CHECK(bus::wire::decode_frame(other, frame).error == bus::wire::FrameError::kFrameCrc, "passes on both channels");
  // Startup without sync is well-formed. The controller refuses it as content, and it cannot be encoded.
  if (decoded.header.startup && !decoded.header.sync) return 0;
  std::array<std::byte, bus::wire::kMaxFrameBytes> encoded{};
  const std::size_t length = bus::wire::encode_frame(decoded.header, channel, decoded.payload, encoded);
  TTF_CHECK(length == frame.size(), "{} bytes of {}", length, frame.size());
  const auto payload = std::span(frame).subspan(kHeaderBytes, decoded.payload.size());
  TTF_CHECK(std::equal(payload.begin(), payload.end(), encoded.begin() + kHeaderBytes), "another payload");
  // The reserved bit is sent as 0 and ignored by receivers: it and the CRCs over it may differ.
  const bool reserved = (frame[0] & std::byte{0x80}) != std::byte{0};
  if (!reserved) TTF_CHECK(std::equal(frame.begin(), frame.end(), encoded.begin()), "other bytes");
  const bus::wire::DecodedFrame again = bus::wire::decode_frame(channel, std::span(encoded).first(length));
  TTF_CHECK(again.error == bus::wire::FrameError::kNone && again.header.header_crc == decoded.header.header_crc &&
                again.header.cycle == decoded.header.cycle && again.header.frame_id == decoded.header.frame_id &&
                again.header.null_frame == decoded.header.null_frame &&
                again.header.payload_preamble == decoded.header.payload_preamble,
            "another header");
  return 0;
}
