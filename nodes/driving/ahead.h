// A service's view of the way ahead: the nearest object of the image in its path, and the own speed by odometry.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::driving {

struct PathConfig {
  // If true, the line of travel is the circle of speed and yaw rate, and else straight.
  bool curved = false;
  // An object whose centre is further off the line of travel is not in the path: half a lane of 3.6 m.
  double half_width_m = 1.8;
  double front_m = 3.4;  // the vehicle's front, ahead of its rear axle
  // The largest difference between an image's predicted instant and its use.
  Duration max_image_age = Duration::milliseconds(100);
  // Beyond this age of its newest list the odometry has stopped, as for the fusion (fusion/ego/odometry.h).
  Duration max_odometry_age = Duration::milliseconds(200);
};

// Reads the keys that services with a view of the way ahead share.
void load_path(YamlMap& yaml, PathConfig& path);

struct ObjectAhead {
  TrackId track{};
  double clearance = 0.0;     // [m], from the vehicle's front to the object's outline
  double speed = 0.0;         // [m/s], over ground, along the vehicle's x axis
  double acceleration = 0.0;  // [m/s^2], likewise
};

struct View {
  double own_speed = 0.0;  // [m/s]
  std::optional<ObjectAhead> ahead;
};

// Returns the place of a task's input among its `reads`; the port is bound.
std::size_t place_of(const schedules::model::Task& task, std::string_view port);

// Ports `image` and `odometry`.
class WayAhead {
 public:
  WayAhead(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const PathConfig& config);
  // Returns nothing without an image and a list of odometry that are fresh enough, or without global time. Call it at each
  // execution.
  std::optional<View> look(const host::StepContext& context);
  // Returns the own speed alone, under the same conditions, for a service that judges the image's objects itself.
  std::optional<double> own_speed(const host::StepContext& context);
  // Replaces `objects` by those of the newest image, which there must be.
  void list(const host::StepContext& context, std::vector<recording::records::ImageObject>& objects) const;
  std::size_t most_objects() const { return most_objects_; }

 private:
  // `curvature` [1/m] is that of the line of travel.
  std::optional<ObjectAhead> nearest(const host::Input& image, double curvature) const;

  PathConfig config_;
  Duration round_;
  std::size_t image_ = 0, odometry_ = 0;  // the ports' places among the inputs
  std::size_t most_objects_ = 0;
  std::array<std::size_t, 4> motion_;  // the signals of odometry
  fusion::ImageSignals signals_;
  GlobalTime valid_at_{};     // the newest image's
  GlobalTime measured_at_{};  // the newest list's of odometry
};

}  // namespace ttf::nodes::driving
