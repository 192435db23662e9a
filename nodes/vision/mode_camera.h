// Several cameras that share one detector whose frames are modes of its task (schedules/model/task_modes.h). It does not plan:
// each execution is a detection, and the mode says when it begins, of which camera it is and how long it lasts.
//
// An execution looks at the camera's newest picture (look.h). Its list leaves at the execution's end, even if the detection
// takes less time. A detection that would take longer gives what it has by then. Without a picture, or without a region for a
// secondary detection, the execution writes nothing.
//
// Where a frame begins, the step chooses its mode by the regions that there are then (mode_choice.h). A frame is recorded as it
// begins, and a detection likewise, with the time that it takes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/host/step.h"
#include "nodes/vision/config.h"
#include "nodes/vision/look.h"
#include "nodes/vision/mode_choice.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::vision {

// Ports: those of AdaptiveCamera.
class ModeCamera final : public host::Step {
 public:
  // `cameras` are in the order of the ports read, without `regions`. The task has modes.
  ModeCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
             const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view) const override { return true; }

 private:
  struct Frame {
    std::string letters;
    Duration length{};
  };
  void begin_frame(host::StepContext& context);

  std::vector<schedules::model::TaskMode> modes_;
  std::vector<Frame> frames_;  // by mode
  ModeChoice choice_;
  Looking looking_;
  std::uint32_t begun_ = 0;  // frames
};

}  // namespace ttf::nodes::vision
