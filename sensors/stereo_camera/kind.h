// The row of stereo cameras.
#pragma once

#include "sensors/kind.h"
#include "sensors/stereo_camera/emulator.h"
#include "sensors/stereo_camera/preprocessing.h"

namespace ttf::sensors::stereo_camera {

struct Kind {
  static constexpr schedules::model::SensorKind kKind = schedules::model::SensorKind::kCamera;
  using Model = CameraConfig;
  using Preprocessing = CameraCalibration;
  using EmulatorStep = CameraEmulator;
  using PreprocessingStep = CameraPreprocessing;

  static Model load_model(YamlMap& yaml) { return load_camera(yaml); }
  static Preprocessing load_preprocessing(YamlMap& yaml) { return load_camera_calibration(yaml); }
  static Model in_weather(const Model& model, const sim::world::Weather& weather) {
    return stereo_camera::in_weather(model, weather);
  }
  static std::optional<fusion::sensors::Field> field_of(const Model& model) {
    return with_blind({.half_angle = model.half_field_rad, .max_range = model.max_range_m, .shadow = model.shadow},
                      model.device);
  }
  static std::optional<double> rate_span(const Model&) { return std::nullopt; }
  static std::optional<fusion::sensors::Resolution> resolution(const Preprocessing&) { return std::nullopt; }
  static constexpr Shows kShows = Shows::kSilhouette;
  static constexpr std::array<SensorSteps, 1> kSteps{
      {{{.step = "camera_emulator", .writes = {"raw"}},
        {.step = "camera_preprocessing", .reads = {"raw"}, .writes = {"objects"}}}}};
};
static_assert(IsKind<Kind>);

}  // namespace ttf::sensors::stereo_camera
