// The sensor devices: they look at the scene when they measure and send raw data over their private CAN, as the real
// ones do.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "nodes/sensing/scene.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"
#include "sim/world/camera.h"
#include "sim/world/laser.h"

namespace ttf::nodes {

struct EmulatorConfig {
  const schedules::Cluster* cluster = nullptr;
  const schedules::Task* task = nullptr;
  SensorId sensor{};
  std::shared_ptr<const Scene> scene;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

// Port `raw`: hit points as layer, azimuth [rad], range [m].
class LaserEmulator final : public Step {
 public:
  LaserEmulator(const EmulatorConfig& config, const world::LaserConfig& laser);
  void run(StepContext& context) override;

 private:
  EmulatorConfig config_;
  world::LaserConfig laser_;
  std::array<std::size_t, 3> signals_;
  std::vector<world::ObjectState> states_;
  std::vector<world::HitPoint> hits_;
  std::vector<ObjectId> truth_;
};

// Port `raw`: detections as bearing [rad], disparity [px], width [px].
class CameraEmulator final : public Step {
 public:
  CameraEmulator(const EmulatorConfig& config, const world::CameraConfig& camera);
  void run(StepContext& context) override;

 private:
  EmulatorConfig config_;
  world::CameraConfig camera_;
  std::array<std::size_t, 3> signals_;
  std::vector<world::ObjectState> states_;
  std::vector<world::CameraDetection> detections_;
  std::vector<ObjectId> truth_;
};

}  // namespace ttf::nodes
