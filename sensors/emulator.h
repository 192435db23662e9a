// The common part of all emulated devices. A device measures the scene and sends raw data over its private CAN, as a real one
// does.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "nodes/host/step.h"
#include "schedules/model/cluster.h"
#include "sensors/device.h"
#include "sensors/lists.h"
#include "sensors/scene.h"

namespace ttf::sensors {

struct EmulatorConfig {
  const schedules::model::Cluster* cluster = nullptr;
  const schedules::model::Task* task = nullptr;
  SensorId sensor{};
  std::shared_ptr<const Scene> scene;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;

  DriveKey drive() const { return {seed, replication, static_cast<std::uint16_t>(sensor)}; }
  const schedules::model::PduLayout& written(std::string_view port) const {
    return layout_written(*cluster, *task, port);
  }
};

class Emulator : public nodes::host::Step {
 protected:
  explicit Emulator(const EmulatorConfig& config);
  // Puts the objects at the measurement's instant into states_, in the sensor's axes. Returns that instant.
  TrueTime look(const nodes::host::StepContext& context, const Device& device);
  MeasurementKey key(const nodes::host::StepContext& context) const;
  // Records the measurement; truth_ has the object of each element.
  void record(const nodes::host::StepContext& context) const;

  EmulatorConfig config_;
  std::vector<ObjectState> states_;
  std::vector<ObjectId> truth_;
};

}  // namespace ttf::sensors
