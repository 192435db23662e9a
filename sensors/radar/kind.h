// The row of radars.
#pragma once

#include "sensors/kind.h"
#include "sensors/radar/emulator.h"
#include "sensors/radar/preprocessing.h"

namespace ttf::sensors::radar {

struct Kind {
  static constexpr schedules::model::SensorKind kKind = schedules::model::SensorKind::kRadar;
  using Model = RadarConfig;
  using Preprocessing = RadarPreprocessingConfig;
  using EmulatorStep = RadarEmulator;
  using PreprocessingStep = RadarPreprocessing;

  static Model load_model(YamlMap& yaml) { return load_radar(yaml); }
  static Preprocessing load_preprocessing(YamlMap& yaml) { return load_radar_preprocessing(yaml); }
  static Model in_weather(const Model& model, const sim::world::Weather& weather) {
    return radar::in_weather(model, weather);
  }
  static std::optional<fusion::sensors::Field> field_of(const Model& model) {
    return with_blind({.half_angle = model.half_field_rad, .max_range = model.max_range_m, .shadow = model.shadow},
                      model.device);
  }
  static std::optional<double> rate_span(const Model& model) { return model.rate_span_mps; }
  static std::optional<fusion::sensors::Resolution> resolution(const Preprocessing& preprocessing) {
    return resolution_of(preprocessing);
  }
  static constexpr Shows kShows = Shows::kNothing;
  static constexpr std::array<SensorSteps, 1> kSteps{
      {{{.step = "radar_emulator", .writes = {"raw"}},
        {.step = "radar_preprocessing", .reads = {"raw"}, .writes = {"objects"}}}}};
};
static_assert(IsKind<Kind>);

}  // namespace ttf::sensors::radar
