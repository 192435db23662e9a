// The health of a process or a node of the launch, for ROS' diagnostics.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/time.h"

namespace ttf::bus::dds::ros {

// The numbers of diagnostic_msgs/msg/DiagnosticStatus.
enum class HealthLevel : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

struct HealthValue {
  std::string_view key;    // "late wake-ups"
  std::string_view value;  // "3"
};

struct Health {
  TrueTime at{};
  HealthLevel level = HealthLevel::kOk;
  std::string_view name;     // the subject: "fusion: schedule"
  std::string_view message;  // in words: "normal active"
  std::span<const HealthValue> values;
};

}  // namespace ttf::bus::dds::ros
