// Several cameras that share one detector. It looks at one picture at a time: at the whole of it, or at its region of
// interest. Wolfe, "Adaptive object detection for autonomous vehicles" (Northern Illinois University, 2020).
//
// The task is executed once a step. An execution without a detection at work begins the frame's next one
// (frame_plan.h). It takes the camera's newest picture and keeps it (look.h). A detection of time T ends ceil(T / step)
// steps later, and at least two (schedules/sequence/history.h). The execution that ends it writes its result, and begins
// the next one. All others write nothing. No clock of the machine is asked.
//
// A camera without a picture costs its detection and a step. A detection takes at most as long as the task may hold a
// list (schedules::model::Task::holds), in whole steps. Then the detector gives what it has. The mean time of a whole
// picture is not cut: sim/drives/detectors.h refuses that. If the task missed executions for so long, the detection is
// dropped.
//
// A task with modes does not plan (nodes/vision/mode_camera.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "nodes/host/step.h"
#include "nodes/vision/config.h"
#include "nodes/vision/frame_plan.h"
#include "nodes/vision/look.h"

namespace ttf::nodes::vision {

// Ports: each camera's boxes, by the sensor's name -> its observations, by that name and `_objects`. Port `regions`, if
// it is bound: a list of regions (regions.h). The order of the cameras among the ports read is that of their letters.
class AdaptiveCamera final : public host::Step {
 public:
  // `cameras` are in the order of the ports read, without `regions`.
  AdaptiveCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view) const override { return true; }  // it looks at the newest picture

 private:
  // The detection at work.
  struct Work {
    Look look;
    LocalTime begin{};
    std::int64_t steps_left = 0;
  };
  void finish(host::StepContext& context);
  void begin(host::StepContext& context);
  void begin_frame(host::StepContext& context);
  void begin_detection(host::StepContext& context, std::size_t camera, bool secondary);

  Duration step_, holds_;  // whole steps
  FramePlan plan_;
  std::vector<double> shares_;  // by camera; room for planning
  Looking looking_;
  std::optional<Work> work_;
};

}  // namespace ttf::nodes::vision
