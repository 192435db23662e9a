// The time of one CAN frame with given data on the wire, stuff bits counted one by one (ISO 11898-1:2015).
// Bounds for any data are in schedules/analysis/can_load.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::wire {

// Returns the time from the start of frame to the end of the intermission (bus idle again), rounded up to
// whole nanoseconds. Frames are base frames: only the identifier's low 11 bits count. The data must have a
// length that a frame can have.
Duration can_frame_duration(const schedules::model::CanBus& bus, std::uint32_t identifier,
                            std::span<const std::byte> data);

}  // namespace ttf::bus::wire
