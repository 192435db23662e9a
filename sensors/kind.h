// The row of a kind of sensor, in its folder's kind.h. sensors/kinds/sensors.h has all rows in one table.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/strict_yaml.h"
#include "fusion/sensors/known_sensor.h"
#include "schedules/model/cluster.h"
#include "schedules/model/ports.h"
#include "sensors/device.h"
#include "sensors/emulator.h"
#include "sim/world/weather.h"

namespace ttf::sensors {

// The step of a device and that of its preprocessing, with their ports.
struct SensorSteps {
  schedules::model::StepPorts emulator, preprocessing;
};

// The part of an object that an observation shows, as far as the expected error of a drive takes it
// (experiments/sweep/expected_drive.h).
enum class Shows : std::uint8_t {
  kNothing,
  kFace,       // the ends of a face, and its direction
  kSilhouette  // a width in the picture; Preprocessing has focal_px and width_sigma_px
};

// `Model` is the sensor as the world emulates it, `Preprocessing` what its host assumes of it.
template <class Kind>
concept IsKind = requires(YamlMap& yaml, const typename Kind::Model& model,
                          const typename Kind::Preprocessing& preprocessing, const sim::world::Weather& weather) {
  { Kind::kKind } -> std::convertible_to<schedules::model::SensorKind>;
  { Kind::load_model(yaml) } -> std::same_as<typename Kind::Model>;
  { Kind::load_preprocessing(yaml) } -> std::same_as<typename Kind::Preprocessing>;
  { model.device } -> std::convertible_to<Device>;
  { Kind::in_weather(model, weather) } -> std::same_as<typename Kind::Model>;
  // The field of view that the fusion assumes; none for one that observes no objects.
  { Kind::field_of(model) } -> std::same_as<std::optional<fusion::sensors::Field>>;
  // The span up to whose multiples range rates are known [m/s]; none for a kind without range rates.
  { Kind::rate_span(model) } -> std::same_as<std::optional<double>>;
  // The returns that its preprocessing joins to one object; none for a kind without returns.
  { Kind::resolution(preprocessing) } -> std::same_as<std::optional<fusion::sensors::Resolution>>;
  { Kind::kShows } -> std::convertible_to<Shows>;
  { Kind::kSteps[0] } -> std::convertible_to<SensorSteps>;
  requires std::constructible_from<typename Kind::EmulatorStep, const EmulatorConfig&, const typename Kind::Model&>;
  requires std::constructible_from<typename Kind::PreprocessingStep, const schedules::model::Cluster&,
                                   const schedules::model::Task&, const typename Kind::Preprocessing&>;
};

// Returns the field with the device's blind sides. A sensor that is switched off reaches nothing.
inline fusion::sensors::Field with_blind(fusion::sensors::Field field, const Device& device) {
  static_assert(fusion::sensors::Field::kMostBlind == BlindSides::kMost);
  if (!device.enabled) field.max_range = 0.0;
  field.blind_sectors = device.blind.count;
  for (std::size_t i = 0; i < device.blind.count; ++i)
    field.blind[i] = {device.blind.sectors[i].from, device.blind.sectors[i].to};
  return field;
}

}  // namespace ttf::sensors
