// How long a CAN frame takes: exact for given data, worst case for the schedule (ISO 11898-1; Davis, Burns, Bril,
// Lukkien: "Controller Area Network schedulability analysis", Real-Time Systems 35, 2007).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.h"
#include "schedules/cluster.h"

namespace ttf::wire {

// CAN FD lengths are 0..8, 12, 16, 20, 24, 32, 48, 64: the smallest that holds `bytes`. Classic CAN: bytes itself.
int can_length(bool flexible_data_rate, int bytes);

// From start of frame to the end of the intermission (bus idle again), rounded up to whole nanoseconds.
Duration can_frame_duration(const schedules::CanBus& bus, std::uint32_t identifier, std::span<const std::byte> data);
// The same with worst-case bit stuffing for any data of that length.
Duration can_frame_worst_case(const schedules::CanBus& bus, int bytes);
// With no stuff bits beyond the fixed ones.
Duration can_frame_best_case(const schedules::CanBus& bus, int bytes);

}  // namespace ttf::wire
