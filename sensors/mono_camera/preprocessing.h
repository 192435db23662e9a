// The host's preprocessing of a camera with one lens: boxes by the ground plane, and marks of lanes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sensors/mono_camera/ground_plane.h"
#include "sensors/mono_camera/mark_memory.h"
#include "sensors/preprocessing.h"

namespace ttf::sensors::mono_camera {

// The host's marks: both ports, and their signals.
struct ListedLanes {
  std::size_t in = 0, out = 0;
  std::array<std::size_t, 3> raw{};
  std::array<std::size_t, 7> signals{};
  MarkCalibration calibration;
  MarkMemory memory;
  std::vector<SeenMark> marks;
};

// Ports: `raw` (left, right, bottom, top, class) -> `objects` (position and its covariance, span of the silhouette, and the class
// if the list has one). A camera of lanes has also `marks` (offset, heading, curvature) -> `lanes` (the same with their sigmas and
// the validity). The device sends the marks before the boxes. Marks of another picture are left out.
class MonoCameraPreprocessing final : public Preprocessing {
 public:
  MonoCameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                          const MonoCalibration& calibration);

 private:
  void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) override;
  void process_lanes(nodes::host::StepContext& context, const nodes::host::Strobe& measurement);

  std::array<std::size_t, 5> raw_;
  std::vector<std::size_t> signals_;
  GroundPlane plane_;
  std::size_t objects_port_;
  std::vector<CameraObject> objects_;
  std::optional<ListedLanes> lanes_;
};

}  // namespace ttf::sensors::mono_camera
