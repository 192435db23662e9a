// Bytes of frames that are on their way. Slots are reused, so a long run needs no more memory than a short one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bus/wire/flexray_crc.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::sim::medium {

class FramePool {
 public:
  static constexpr std::size_t kMaxBytes = 264;  // the longest FlexRay frame is 262

  // Reserves room for `capacity` frames without touching it: most of it is never used.
  explicit FramePool(std::size_t capacity) {
    frames_.reserve(capacity);
    free_.reserve(capacity);
  }

  // Stores a copy of a FlexRay frame for `uses` deliveries, and decodes it once for all receivers.
  std::uint32_t put_frame(schedules::model::Channel channel, std::span<const std::byte> bytes, int uses) {
    const std::uint32_t index = put(bytes, uses);
    frames_[index].decoded = bus::wire::decode_frame(channel, this->bytes(index));
    return index;
  }
  // Stores a copy of a frame's content, as if it had been encoded and decoded. It has no bytes.
  std::uint32_t put_content(const bus::wire::DecodedFrame& content, int uses) {
    const std::uint32_t index = put(content.payload, uses);
    bus::wire::DecodedFrame& decoded = frames_[index].decoded;
    decoded = content;
    const bus::wire::FrameHeader& header = content.header;
    decoded.header.header_crc =
        bus::wire::header_crc(header.sync, header.startup, header.frame_id, header.payload_words);
    decoded.payload = this->bytes(index);
    return index;
  }
  const bus::wire::DecodedFrame& decoded(std::uint32_t index) const { return frames_[index].decoded; }
  // Stores a copy for `uses` deliveries.
  std::uint32_t put(std::span<const std::byte> bytes, int uses) {
    TTF_CHECK(bytes.size() <= kMaxBytes && uses > 0, "{} bytes, {} uses", bytes.size(), uses);
    if (free_.empty()) {
      TTF_CHECK(frames_.size() < frames_.capacity(), "all {} frames are on their way", frames_.size());
      free_.push_back(static_cast<std::uint32_t>(frames_.size()));
      frames_.emplace_back();
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    Frame& frame = frames_[index];
    std::copy(bytes.begin(), bytes.end(), frame.bytes.begin());
    frame.size = bytes.size();
    frame.uses = uses;
    return index;
  }
  std::span<const std::byte> bytes(std::uint32_t index) const {
    return {frames_[index].bytes.data(), frames_[index].size};
  }
  void use(std::uint32_t index, int more) { frames_[index].uses += more; }
  void release(std::uint32_t index, int uses = 1) {
    if ((frames_[index].uses -= uses) == 0) free_.push_back(index);
  }

 private:
  struct Frame {
    std::array<std::byte, kMaxBytes> bytes;
    std::size_t size = 0;
    int uses = 0;
    bus::wire::DecodedFrame decoded;  // for a FlexRay frame
  };
  std::vector<Frame> frames_;
  std::vector<std::uint32_t> free_;
};

}  // namespace ttf::sim::medium
