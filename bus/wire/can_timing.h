// How long a CAN frame with given data takes on the wire, stuff bits counted one by one (ISO 11898-1:2015). What any
// data may take is the schedule's affair: schedules/analysis/can_load.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::wire {

// From start of frame to the end of the intermission (bus idle again), rounded up to whole nanoseconds. Base frames:
// the identifier's low 11 bits count. The data must be as long as a frame can be.
Duration can_frame_duration(const schedules::model::CanBus& bus, std::uint32_t identifier,
                            std::span<const std::byte> data);

}  // namespace ttf::bus::wire
