// Several cameras that share one detector. It looks at one picture at a time: at the whole of it, or at its region of
// interest. Wolfe, "Adaptive object detection for autonomous vehicles" (Northern Illinois University, 2020).
//
// The task is executed once a step. An execution without a detection at work begins the frame's next one
// (frame_plan.h). It takes the camera's newest picture and keeps it. A detection takes
//   T = factor * picture_time * area * (1 + N(0, deviation^2)).
// Here `area` is the share of the picture that it looks at. It ends ceil(T / step) steps later, and at least two
// (schedules/sequence/history.h). The execution that ends it writes its result, and begins the next one. All others
// write nothing. No clock of the machine is asked.
//
// A picture is looked at once. It may be kOldestPicture steps old. A camera without one costs its detection and a step.
// A detection takes at most as long as the task may hold a list (schedules::model::Task::holds), in whole steps. Then
// the detector gives what it has. The mean time of a whole picture is not cut: drives/detectors.h refuses that. If the
// task missed executions for so long, the detection is dropped.
//
// The camera's model finds the boxes (sim/world/mono_camera.h). A primary detection lists them all. A secondary one
// lists those whose middle lies in the region. So clutter falls with the region's area.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/camera/ground_plane.h"
#include "nodes/host/step.h"
#include "nodes/vision/frame_plan.h"
#include "nodes/vision/regions.h"

namespace ttf::nodes::vision {

// A region of interest that a scenario states instead of a planner.
struct FixedRegion {
  std::string camera;
  int line = 0;  // in the scenario
  Region region;
};

struct AdaptiveCameraConfig {
  FramePlanConfig plan;
  Duration picture_time = Duration::microseconds(231'500);  // of a whole picture, on the machine where it was measured
  double hardware_factor = 0.2;                             // this machine's times over those of that one
  double deviation = 0.1;                                   // standard deviation of a time, as a share of it
  double smallest_region_px = 64.0;                         // a smaller region grows to this width and height
  Duration oldest_region = Duration::milliseconds(500);
  std::vector<FixedRegion> regions;
};
AdaptiveCameraConfig load_adaptive_camera(YamlMap& yaml);
// Returns the mean time of a detection in a whole picture.
Duration whole_picture(const AdaptiveCameraConfig& config);

// A camera of the detector: its picture reaches this far from its middle.
struct SharedCamera {
  double half_width_px = 0.0, half_height_px = 0.0;
  camera::MonoCalibration calibration;
};

// The key from which the times of detections are drawn.
struct DetectionKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

// Ports: each camera's boxes, by the sensor's name -> its observations, by that name and `_objects`. Port `regions`, if
// it is bound: a list of regions (regions.h). The order of the cameras among the ports read is that of their letters.
class AdaptiveCamera final : public host::Step {
 public:
  static constexpr int kOldestPicture = 3;

  // `cameras` are in the order of the ports read, without `regions`.
  AdaptiveCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key);
  void run(host::StepContext& context) override;

 private:
  struct Camera {
    SensorId sensor{};
    std::size_t in = 0, out = 0;  // the ports' places
    std::array<std::size_t, 5> raw{};
    std::array<std::size_t, 7> signals{};
    SharedCamera picture;
    camera::GroundPlane plane;
    GlobalTime looked_at{INT64_MIN};  // its last picture
    std::optional<Region> fixed, region;

    double area() const { return 4.0 * picture.half_width_px * picture.half_height_px; }
  };
  // The detection at work.
  struct Work {
    std::size_t camera = 0;
    host::Strobe picture;
    recording::records::DetectionMade record;
    LocalTime begin{};
    std::int64_t steps_left = 0;
  };
  void read_regions(host::StepContext& context);
  std::optional<Region> grown(const Camera& camera, const Region& region) const;
  void finish(host::StepContext& context);
  void begin(host::StepContext& context);
  void begin_frame(host::StepContext& context);
  void look(host::StepContext& context, std::size_t camera, bool secondary);
  Duration drawn_time(SensorId sensor, std::uint32_t picture, double share) const;

  AdaptiveCameraConfig config_;
  DetectionKey key_;
  Duration step_, round_, holds_;  // whole steps
  std::vector<Camera> cameras_;
  FramePlan plan_;
  struct RegionPort {
    std::size_t in = 0;
    RegionSignals signals;
    GlobalTime issued{};
    std::vector<Region> newest;
  };
  std::optional<RegionPort> regions_;
  std::vector<double> shares_;  // by camera; room for planning
  std::optional<Work> work_;
  std::vector<camera::CameraObject> objects_;  // found by the detection at work
};

}  // namespace ttf::nodes::vision
