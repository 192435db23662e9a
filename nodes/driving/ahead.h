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
#include "nodes/driving/known_tracks.h"
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
  // Without a newer image the object ahead is predicted for this long beyond it: the time that the competent driver of
  // UN R157 takes to evaluate a risk.
  Duration prediction = Duration::milliseconds(400);
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

// Returns the object `dt_s` seconds later, when the vehicle has gone `way_m`. It keeps its acceleration until it
// stands.
ObjectAhead predicted(const ObjectAhead& ahead, double dt_s, double way_m);

// Ports `image` and `odometry`.
class WayAhead {
 public:
  WayAhead(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const PathConfig& config);
  // Returns nothing without an image and a list of odometry that are fresh enough, or without global time. Call it at
  // each execution. A new image is taken as it is: the fusion has predicted it to its use. In one that was there
  // before, the object ahead is predicted on, until the image is older than `max_image_age` and `prediction` together.
  // Tracks that images have had for less than `known_for` are not ahead.
  std::optional<View> look(const host::StepContext& context, Duration known_for = {});
  // Returns the own speed alone, without prediction, for a service that judges the image's objects itself.
  std::optional<double> own_speed(const host::StepContext& context);
  // Replaces `objects` by those of the newest image, which there must be.
  void list(const host::StepContext& context, std::vector<recording::records::ImageObject>& objects) const;
  std::size_t most_objects() const { return most_objects_; }

 private:
  void note_image(const host::StepContext& context);
  std::optional<double> speed_with_image(const host::StepContext& context, Duration oldest);
  // Returns how far the vehicle has gone since the image's instant [m].
  double way_since_image(const host::StepContext& context, double speed);
  // `curvature` [1/m] is that of the line of travel.
  std::optional<ObjectAhead> nearest(const host::Input& image, double curvature, Duration known_for) const;

  PathConfig config_;
  Duration round_;
  std::size_t image_ = 0, odometry_ = 0;  // the ports' places among the inputs
  std::size_t most_objects_ = 0;
  std::array<std::size_t, 4> motion_;  // the signals of odometry
  fusion::ImageSignals signals_;
  KnownTracks known_;
  // The newest image's instant, on this node's local time: the count of the cluster's rounds may be another one after a
  // loss of global time.
  std::optional<LocalTime> valid_at_;
  GlobalTime measured_at_{};  // the newest list's of odometry
  // The own way since the newest image's instant, up to an instant at which the speed was known.
  double way_m_ = 0.0;
  LocalTime way_until_{};
  std::optional<double> speed_then_;
};

}  // namespace ttf::nodes::driving
