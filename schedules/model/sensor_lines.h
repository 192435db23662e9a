// The two wires between a sensor and its host as CAN frames, for media that carry only frames. One is a trigger
// to the device. The other is a strobe back at the instant of measuring; its arrival is the measurement's time
// stamp. Both use the CAN of the device's raw data. They have its lowest identifiers and so precede all other
// messages there. In real time no message of that CAN may use these identifiers
// (schedules/check/real_time_rules.h, W6).
//
//   trigger   identifier 2 s + 2   no data
//   strobe    identifier 2 s + 1   the measurement's number, 4 bytes, most significant first (bus/wire/strobe.h)
//
// s is the sensor's index in the cluster file, from 0. Both are classic CAN frames, on CAN FD as well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/ids.h"
#include "schedules/model/cluster.h"
#include "schedules/model/limits.h"

namespace ttf::schedules::model {

inline constexpr std::size_t kStrobeBytes = 4;

constexpr std::uint32_t strobe_identifier(SensorId sensor) { return 2 * static_cast<std::uint32_t>(sensor) + 1; }
constexpr std::uint32_t trigger_identifier(SensorId sensor) { return 2 * static_cast<std::uint32_t>(sensor) + 2; }
static_assert(trigger_identifier(static_cast<SensorId>(kMostNamed - 1)) < 0x7FF, "as a CAN identifier of 11 bits");

// Returns the CAN of the device's raw data; nullopt if it sends none.
std::optional<std::size_t> can_of_lines(const Cluster& cluster, SensorId sensor);

}  // namespace ttf::schedules::model
