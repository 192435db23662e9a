// The two CRCs of a FlexRay frame (FlexRay 2.1A, chapter 4.5).
//
// clang-format off
//   header  11 bits, x^11+x^9+x^8+x^7+x^2+1 (0x385), initial 0x01A, over sync, startup, frame id and payload length
//   frame   24 bits, 0x5D6DCB, initial 0xFEDCBA on channel A and 0xABCDEF on B, over header and payload
// clang-format on
//
// Neither is reflected or inverted at the end. The initial values differ so that a frame on the wrong channel
// fails the check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "schedules/model/cluster.h"

namespace ttf::bus::wire {

std::uint16_t header_crc(bool sync, bool startup, std::uint16_t frame_id, std::uint8_t payload_words);

// Eight bytes at a step (slicing by 8: Kounavis and Berry, "Novel table lookup-based algorithms for
// high-performance CRC generation", IEEE Transactions on Computers 57 (2008)).
std::uint32_t frame_crc(schedules::model::Channel channel, std::span<const std::byte> header_and_payload);

}  // namespace ttf::bus::wire
