// Looking at pictures: cameras, their regions of interest, and one detection, for the steps of a shared detector
// (nodes/vision/adaptive_camera.h, nodes/vision/mode_camera.h).
//
// A detection takes
//   T = factor * picture_time * area * (1 + N(0, deviation^2)).
// Here `area` is the share of the picture that it looks at. The time is drawn by the seed, the camera and the picture.
// A picture is looked at once. It may be kOldestPicture steps old.
//
// The camera's model finds the boxes (sensors/mono_camera/model.h). A primary detection lists them all. A secondary one
// lists those whose middle lies in the region. So clutter falls with the region's area.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "nodes/host/step.h"
#include "nodes/vision/config.h"
#include "nodes/vision/regions.h"
#include "sensors/mono_camera/ground_plane.h"

namespace ttf::nodes::vision {

// A detection: of which picture, and as it is recorded.
struct Look {
  std::size_t camera = 0;
  host::Strobe picture;
  recording::records::DetectionMade record;
};

class Looking {
 public:
  static constexpr int kOldestPicture = 3;

  // `cameras` are in the order of the ports read, without `regions`. Pictures come once a step.
  Looking(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
          const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key,
          Duration step);

  // Takes in the newest list of regions; to be called at each execution.
  void read_regions(host::StepContext& context);
  std::size_t cameras() const { return cameras_.size(); }
  bool has_region(std::size_t camera) const { return cameras_[camera].region.has_value(); }
  // Returns the camera's region of interest as a share of its picture, 0 for none.
  double share(std::size_t camera) const;

  // Looks at the camera's newest picture, if it has one for this: for `longest` at most. A secondary look needs a region.
  std::optional<Look> look(host::StepContext& context, std::size_t camera, bool secondary, Duration longest);
  // Writes the objects that the last look() found, and records them.
  void write(host::StepContext& context, const Look& look);

 private:
  struct Camera {
    SensorId sensor{};
    std::size_t in = 0, out = 0;  // the ports' places
    std::array<std::size_t, 5> raw{};
    std::array<std::size_t, 7> signals{};
    SharedCamera picture;
    sensors::mono_camera::GroundPlane plane;
    GlobalTime looked_at{INT64_MIN};  // its last picture
    std::optional<Region> fixed, region;

    double area() const { return 4.0 * picture.half_width_px * picture.half_height_px; }
  };
  struct RegionPort {
    std::size_t in = 0;
    RegionSignals signals;
    GlobalTime issued{};
    std::vector<Region> newest;
  };
  std::optional<Region> grown(const Camera& camera, const Region& region) const;
  Duration drawn_time(SensorId sensor, std::uint32_t picture, double share) const;

  AdaptiveCameraConfig config_;
  DetectionKey key_;
  Duration step_, round_;
  std::vector<Camera> cameras_;
  std::optional<RegionPort> regions_;
  std::vector<sensors::stereo_camera::CameraObject> objects_;  // found by the last look
};

}  // namespace ttf::nodes::vision
