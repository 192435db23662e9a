// The steps of a camera with one lens: its device, and its host's preprocessing by the ground plane. A camera of lanes has a
// second list, of the marks of lanes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "nodes/camera/ground_plane.h"
#include "nodes/camera/mark_memory.h"
#include "nodes/host/step.h"
#include "nodes/sensing/emulators.h"
#include "sim/world/mono_camera.h"

namespace ttf::nodes::sensing {

// The device's marks: the port, its signals, and room for a list.
struct MeasuredMarks {
  std::size_t port = 0;
  std::array<std::size_t, 3> signals{};
  std::vector<sim::world::LaneMark> there, seen;
  std::vector<std::uint16_t> truth;
};

// Port `raw`: boxes as left, right, bottom, top [px] and class (sim::world::traffic::ObjectClass). Port `marks`, if the task has it: offset
// [m], heading [rad], curvature [1/m].
class MonoCameraEmulator final : public host::Step {
 public:
  MonoCameraEmulator(const EmulatorConfig& config, const sim::world::MonoCameraConfig& camera);
  void run(host::StepContext& context) override;

 private:
  EmulatorConfig config_;
  sim::world::MonoCameraConfig camera_;
  std::array<std::size_t, 5> signals_;
  std::size_t raw_port_;
  std::vector<sim::world::ObjectState> states_;
  sim::world::MonoCameraRoom room_;
  std::vector<sim::world::MonoBox> boxes_;
  std::vector<ObjectId> truth_;
  std::optional<MeasuredMarks> marks_;
};

// The host's marks: both ports, and their signals.
struct ListedLanes {
  std::size_t in = 0, out = 0;
  std::array<std::size_t, 3> raw{};
  std::array<std::size_t, 7> signals{};
  camera::MarkCalibration calibration;
  camera::MarkMemory memory;
  std::vector<camera::SeenMark> marks;
};

// Ports: `raw` (left, right, bottom, top, class) -> `objects` (position and its covariance, span of the silhouette). A camera of
// lanes has also `marks` (offset, heading, curvature) -> `lanes` (the same with their sigmas and the validity). The device
// sends the marks before the boxes. Marks of another picture are left out.
class MonoCameraPreprocessing final : public host::Step {
 public:
  MonoCameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                          const camera::MonoCalibration& calibration);
  void run(host::StepContext& context) override;

 private:
  void run_lanes(host::StepContext& context, const host::Strobe& measurement);

  SensorId sensor_;
  std::array<std::size_t, 5> raw_;
  std::array<std::size_t, 7> signals_;
  camera::GroundPlane plane_;
  std::size_t objects_port_;
  std::vector<camera::CameraObject> objects_;
  std::optional<ListedLanes> lanes_;
};

}  // namespace ttf::nodes::sensing
