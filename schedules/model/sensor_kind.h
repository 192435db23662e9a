// The kinds of sensors, as far as a schedule sees them. Model, preprocessing and steps of a kind are in its folder below sensors/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::schedules::model {

enum class SensorKind : std::uint8_t { kLaser, kCamera, kRadar, kMonoCamera, kOdometry };

struct SensorKindRow {
  SensorKind kind;
  std::string_view word;  // in cluster files, scenarios and logs
  bool observes = true;   // its lists are of objects; else they are of the sensors' own vehicle
  bool rates = false;     // it measures range rates
  bool pictures = false;  // it lists boxes of pictures, which a detector can look at
};
inline constexpr std::array<SensorKindRow, 5> kSensorKinds{
    {{.kind = SensorKind::kLaser, .word = "laser"},
     {.kind = SensorKind::kCamera, .word = "camera"},
     {.kind = SensorKind::kRadar, .word = "radar", .rates = true},
     {.kind = SensorKind::kMonoCamera, .word = "mono_camera", .pictures = true},
     {.kind = SensorKind::kOdometry, .word = "odometry", .observes = false}}};

constexpr const SensorKindRow& row_of(SensorKind kind) { return kSensorKinds[static_cast<std::size_t>(kind)]; }
constexpr bool in_order(std::size_t from = 0) {
  for (; from < kSensorKinds.size(); ++from)
    if (static_cast<std::size_t>(kSensorKinds[from].kind) != from) return false;
  return true;
}
static_assert(in_order(), "row_of() finds a kind's row by its number");

// Returns the words with their kinds, for a key whose value is a kind.
inline std::vector<std::pair<std::string_view, SensorKind>> kind_choices() {
  std::vector<std::pair<std::string_view, SensorKind>> choices;
  for (const SensorKindRow& row : kSensorKinds) choices.emplace_back(row.word, row.kind);
  return choices;
}

}  // namespace ttf::schedules::model
