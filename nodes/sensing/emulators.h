// The sensor devices: they measure the scene and send raw data over their private CAN, as real ones do.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "nodes/host/step.h"
#include "nodes/sensing/scene.h"
#include "schedules/model/cluster.h"
#include "sim/world/camera.h"
#include "sim/world/laser.h"
#include "sim/world/radar.h"

namespace ttf::nodes::sensing {

struct EmulatorConfig {
  const schedules::model::Cluster* cluster = nullptr;
  const schedules::model::Task* task = nullptr;
  SensorId sensor{};
  std::shared_ptr<const Scene> scene;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

// Port `raw`: hit points as layer, azimuth [rad], range [m].
class LaserEmulator final : public host::Step {
 public:
  LaserEmulator(const EmulatorConfig& config, const sim::world::LaserConfig& laser);
  void run(host::StepContext& context) override;

 private:
  EmulatorConfig config_;
  sim::world::LaserConfig laser_;
  std::array<std::size_t, 3> signals_;
  std::vector<sim::world::ObjectState> states_;
  std::vector<sim::world::HitPoint> hits_;
  std::vector<ObjectId> truth_;
};

// Port `raw`: detections as bearing [rad], disparity [px], width [px].
class CameraEmulator final : public host::Step {
 public:
  CameraEmulator(const EmulatorConfig& config, const sim::world::CameraConfig& camera);
  void run(host::StepContext& context) override;

 private:
  EmulatorConfig config_;
  sim::world::CameraConfig camera_;
  std::array<std::size_t, 3> signals_;
  std::vector<sim::world::ObjectState> states_;
  sim::world::CameraRoom room_;
  std::vector<sim::world::CameraDetection> detections_;
  std::vector<ObjectId> truth_;
};

// Port `raw`: returns as range [m], azimuth [rad], range_rate [m/s], power [dB over the noise].
class RadarEmulator final : public host::Step {
 public:
  RadarEmulator(const EmulatorConfig& config, const sim::world::RadarConfig& radar);
  void run(host::StepContext& context) override;

 private:
  EmulatorConfig config_;
  sim::world::RadarConfig radar_;
  std::array<std::size_t, 4> signals_;
  std::vector<sim::world::ObjectState> states_;
  sim::world::RadarRoom room_;
  std::vector<sim::world::RadarReturn> returns_;
  std::vector<ObjectId> truth_;
};

}  // namespace ttf::nodes::sensing
