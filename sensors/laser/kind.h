// The row of laser scanners.
#pragma once

#include "sensors/kind.h"
#include "sensors/laser/emulator.h"
#include "sensors/laser/preprocessing.h"

namespace ttf::sensors::laser {

struct Kind {
  static constexpr schedules::model::SensorKind kKind = schedules::model::SensorKind::kLaser;
  using Model = LaserConfig;
  using Preprocessing = LaserPreprocessingConfig;
  using EmulatorStep = LaserEmulator;
  using PreprocessingStep = LaserPreprocessing;

  static Model load_model(YamlMap& yaml) { return load_laser(yaml); }
  static Preprocessing load_preprocessing(YamlMap& yaml) { return load_laser_preprocessing(yaml); }
  static Model in_weather(const Model& model, const sim::world::Weather& weather) {
    return laser::in_weather(model, weather);
  }
  // Beams end at the first object.
  static std::optional<fusion::sensors::Field> field_of(const Model& model) {
    return with_blind({.half_angle = model.half_field_rad, .max_range = model.max_range_m}, model.device);
  }
  static std::optional<double> rate_span(const Model&) { return std::nullopt; }
  static std::optional<fusion::sensors::Resolution> resolution(const Preprocessing&) { return std::nullopt; }
  static constexpr Shows kShows = Shows::kFace;
  static constexpr std::array<SensorSteps, 1> kSteps{
      {{{.step = "laser_emulator", .writes = {"raw"}},
        {.step = "laser_preprocessing", .reads = {"raw"}, .writes = {"objects"}}}}};
};
static_assert(IsKind<Kind>);

}  // namespace ttf::sensors::laser
