// Plans the speed behind the most important object (nodes/control/gap_planner.h), and a region of interest around it.
//
// Objects are judged in the axes of the own lane, which is straight. The place on it is that of odometry (own_place.h).
// The gap lies between the own front and the object's outline.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/control/gap_planner.h"
#include "nodes/driving/ahead.h"
#include "nodes/driving/own_place.h"
#include "nodes/driving/plan.h"
#include "nodes/host/step.h"
#include "nodes/vision/regions.h"
#include "recording/records/records.h"

namespace ttf::nodes::driving {

// A camera in the planner's model: its place on the vehicle, and its picture.
struct Picture {
  SensorId sensor = kNoSensor;
  double x = 0.0, y = 0.0, heading = 0.0;  // the mounting [m], [rad]
  double height_m = 1.3;                   // over ground
  double focal_px = 1100.0;
  double half_width_px = 530.0, half_height_px = 400.0;
};

// The part of a picture in which the next detection is to look for an object.
struct InterestConfig {
  double margin_px = 20.0;       // on each side of the box
  double least_area = 0.6;       // a share of the picture; 0: no least area
  double object_height_m = 1.5;  // the image does not say it
};

// Returns the region of interest: the object's predicted box with a margin. It grows about its middle to a share of the
// picture's area, and moves into the picture. A pinhole camera sees a point at depth x, y to the left and z over ground, at
//   column -f y / x,  row f (h - z) / x.
// The object is in the vehicle's axes. There is no region if the middle of its box is not in the picture.
std::optional<vision::Region> region_of(const Picture& picture, const InterestConfig& config,
                                        const recording::records::ImageObject& object);

struct PlannerConfig {
  control::GapPlannerConfig law;
  double lane_width_m = 4.0;
  double width_m = 1.8;  // the own vehicle's; half of it is added on either side of the lane
  PathConfig path;
  InterestConfig interest;
};
// Reads all but the vehicle's front and width.
PlannerConfig load_planner(YamlMap& yaml);

// Ports `image` and `odometry` -> `plan`, and `regions` if it is bound (nodes/vision/regions.h). Each execution issues
// a plan and a list of regions. Without a view of the way ahead the plan is invalid, except for a stop, and nothing is
// of interest.
class MotionPlanner final : public host::Step {
 public:
  // `pictures` are those of the cameras whose regions are looked at; the first one that sees the object gets the region.
  MotionPlanner(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                const PlannerConfig& config, std::vector<Picture> pictures);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view port) const override { return port == "odometry"; }

 private:
  struct Chosen {
    std::size_t index = 0;  // among the image's objects
    control::MostImportant object;
  };
  std::optional<Chosen> most_important(const PoseOnLine& own);
  void report_region(host::StepContext& context, const std::optional<Chosen>& chosen,
                     recording::records::PlanMade& record);

  PlannerConfig config_;
  std::vector<Picture> pictures_;
  WayAhead way_;
  OwnPlace place_;
  PlanOutput plan_;
  std::optional<vision::RegionOutput> regions_;
  std::vector<recording::records::ImageObject> objects_;
  std::vector<control::Candidate> candidates_;
  control::PlannerMemory memory_;
  std::optional<LocalTime> start_;  // the first execution
};

}  // namespace ttf::nodes::driving
