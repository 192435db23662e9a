// FlexRay frames with drawn contents, and accessors for the tests of their mapping onto CAN.
#pragma once

#include <linux/can.h>

#include <cstddef>
#include <span>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/wire/flexray_frame.h"
#include "core/random.h"

namespace ttf::bus::socketcan {

using Bytes = std::vector<std::byte>;

inline Bytes bytes_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }
inline std::span<const std::byte> data_of(const canfd_frame& can) {
  return std::as_bytes(std::span(can.data)).first(can.len);
}

// The same for the same arguments; some are sync, startup or null frames.
inline Bytes drawn_frame(schedules::model::Channel channel, int slot, int cycle, int words) {
  RandomStream draw({.seed = 1,
                     .entity = static_cast<std::uint16_t>(slot),
                     .index = static_cast<std::uint32_t>(cycle * 128 + words)});
  Bytes payload(static_cast<std::size_t>(2 * words));
  for (std::byte& byte : payload) byte = static_cast<std::byte>(draw.integer(0, 255));
  wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot);
  header.cycle = static_cast<std::uint8_t>(cycle);
  header.sync = draw.integer(0, 1) == 1;
  header.startup = header.sync && draw.integer(0, 1) == 1;
  header.null_frame = draw.integer(0, 3) == 0;
  header.payload_preamble = !header.null_frame && draw.integer(0, 1) == 1;
  Bytes frame(wire::kMaxFrameBytes);
  frame.resize(wire::encode_frame(header, channel, payload, frame));
  return frame;
}

// Whether a controller would take it as the frame of that slot.
inline bool sound(schedules::model::Channel channel, const Arrival& arrival, int slot) {
  const wire::DecodedFrame decoded = wire::decode_frame(channel, arrival.frame);
  return arrival.slot == slot && decoded.error == wire::FrameError::kNone && decoded.header.frame_id == slot;
}

}  // namespace ttf::bus::socketcan
