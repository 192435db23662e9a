// The time of one CAN frame with given data on the wire, stuff bits counted one by one (ISO 11898-1:2015).
// Bounds for any data are in schedules/analysis/can_load.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::wire {

// Times since the start of frame, rounded up to whole nanoseconds.
struct CanFrameTimes {
  Duration accepted{};  // the receivers have the frame: the last but one bit of its end of frame is over
  Duration idle{};      // the bus is idle again: the intermission is over
};
// Frames are base frames: only the identifier's low 11 bits count. The data must have a length that a frame can
// have.
CanFrameTimes can_frame_times(const schedules::model::CanBus& bus, std::uint32_t identifier,
                              std::span<const std::byte> data);

// Returns the time until the bus is idle again.
Duration can_frame_duration(const schedules::model::CanBus& bus, std::uint32_t identifier,
                            std::span<const std::byte> data);

}  // namespace ttf::bus::wire
