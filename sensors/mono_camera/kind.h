// The row of cameras with one lens. A camera of lanes has steps of its own.
#pragma once

#include "sensors/kind.h"
#include "sensors/mono_camera/emulator.h"
#include "sensors/mono_camera/preprocessing.h"

namespace ttf::sensors::mono_camera {

struct Kind {
  static constexpr schedules::model::SensorKind kKind = schedules::model::SensorKind::kMonoCamera;
  using Model = MonoCameraConfig;
  using Preprocessing = MonoCalibration;
  using EmulatorStep = MonoCameraEmulator;
  using PreprocessingStep = MonoCameraPreprocessing;

  static Model load_model(YamlMap& yaml) { return load_mono_camera(yaml); }
  static Preprocessing load_preprocessing(YamlMap& yaml) { return load_mono_calibration(yaml); }
  static Model in_weather(const Model& model, const sim::world::Weather& weather) {
    return mono_camera::in_weather(model, weather);
  }
  static std::optional<fusion::sensors::Field> field_of(const Model& model) {
    return with_blind({.half_angle = looked_at(model), .max_range = model.max_range_m}, model.device);
  }
  static std::optional<double> rate_span(const Model&) { return std::nullopt; }
  static std::optional<fusion::sensors::Resolution> resolution(const Preprocessing&) { return std::nullopt; }
  static constexpr Shows kShows = Shows::kNothing;  // expected errors leave its silhouettes out
  static constexpr std::array<SensorSteps, 2> kSteps{
      {{{.step = "mono_camera_emulator", .writes = {"raw"}},
        {.step = "mono_camera_preprocessing", .reads = {"raw"}, .writes = {"objects"}}},
       {{.step = "lane_camera_emulator", .writes = {"raw", "marks"}},
        {.step = "lane_camera_preprocessing", .reads = {"raw", "marks"}, .writes = {"objects", "lanes"}}}}};
};
static_assert(IsKind<Kind>);

}  // namespace ttf::sensors::mono_camera
