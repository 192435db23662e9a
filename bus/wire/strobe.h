// The data of a strobe on a CAN (schedules/model/sensor_lines.h): the measurement's number, most significant
// byte first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "schedules/model/sensor_lines.h"

namespace ttf::bus::wire {

constexpr std::array<std::byte, schedules::model::kStrobeBytes> strobe_data(std::uint32_t sequence) {
  return {static_cast<std::byte>(sequence >> 24), static_cast<std::byte>(sequence >> 16 & 0xFF),
          static_cast<std::byte>(sequence >> 8 & 0xFF), static_cast<std::byte>(sequence & 0xFF)};
}
// Returns no value if the data are not those of a strobe.
constexpr std::optional<std::uint32_t> strobe_sequence(std::span<const std::byte> data) {
  if (data.size() != schedules::model::kStrobeBytes) return std::nullopt;
  std::uint32_t sequence = 0;
  for (const std::byte byte : data) sequence = sequence << 8 | std::to_integer<std::uint32_t>(byte);
  return sequence;
}

}  // namespace ttf::bus::wire
