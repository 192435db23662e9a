// The row of odometry.
#pragma once

#include "sensors/kind.h"
#include "sensors/odometry/emulator.h"
#include "sensors/odometry/preprocessing.h"

namespace ttf::sensors::odometry {

struct Kind {
  static constexpr schedules::model::SensorKind kKind = schedules::model::SensorKind::kOdometry;
  using Model = OdometryConfig;
  using Preprocessing = OdometryPreprocessingConfig;
  using EmulatorStep = OdometryEmulator;
  using PreprocessingStep = OdometryPreprocessing;

  static Model load_model(YamlMap& yaml) { return load_odometry(yaml); }
  static Preprocessing load_preprocessing(YamlMap& yaml) { return load_odometry_preprocessing(yaml); }
  static Model in_weather(const Model& model, const sim::world::Weather&) { return model; }
  static std::optional<fusion::sensors::Field> field_of(const Model&) { return std::nullopt; }
  static std::optional<double> rate_span(const Model&) { return std::nullopt; }
  static std::optional<fusion::sensors::Resolution> resolution(const Preprocessing&) { return std::nullopt; }
  static constexpr Shows kShows = Shows::kNothing;
  static constexpr std::array<SensorSteps, 1> kSteps{
      {{{.step = "odometry_emulator", .writes = {"raw"}},
        {.step = "odometry_preprocessing", .reads = {"raw"}, .writes = {"odometry"}}}}};
};
static_assert(IsKind<Kind>);

}  // namespace ttf::sensors::odometry
