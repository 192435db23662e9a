// A drive as a scene seen from above, gathered from its log: true objects, lists, tracks and warnings over time.
//
// A scene's size is bounded. When it is full, moments that follow another one too soon are left out, and the least spacing
// doubles; at kSparsest the scene ends. Coordinates follow ISO 8855 in the vehicle's frame: metres, radians, m/s.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "recording/scene/moments.h"
#include "recording/scene/viewed.h"

namespace ttf::report::scene {

using recording::scene::OwnMotion;
using recording::scene::Point;
using recording::scene::Pose;
using recording::scene::ViewedSensor;

struct TrueObject {
  ObjectId id{};
  float x = 0, y = 0, heading = 0, length = 0, width = 0;
};
struct ShownTrack {
  TrackId id{};
  float x = 0, y = 0, heading = 0, speed = 0, length = 0, width = 0;
  float sigma_x = 0, sigma_y = 0, correlation = 0;
  recording::records::ImageStatus status{};
};
// The feature service warns of a track. Infinite times are none.
struct Warning {
  TrackId track{};
  float time_to_collision_s = 0, time_gap_s = 0;
};

template <class Part> struct Moment {
  TrueTime at{};
  std::vector<Part> parts;
};

// Moments of each kind are in the order of time, at most one at an instant.
struct Scene {
  std::vector<ViewedSensor> sensors;              // by SensorId
  std::vector<Moment<TrueObject>> truth;          // at the instants at which a node recorded it
  std::vector<Moment<ShownTrack>> images;         // at the instants to which they are predicted
  std::vector<Moment<OwnMotion>> own;             // beside images whose velocities are over ground: one part
  std::vector<std::vector<Moment<Point>>> lists;  // by SensorId, at the instants of measuring
  std::vector<Moment<Warning>> warnings;          // at uses of an image; each holds until the next
  Duration spacing{};                             // least time between moments of one kind; zero: all are there
  TrueTime first{}, last{};                       // the moments' ends; both zero without any
  TrueTime end{};                                 // the end of the log's moments
  bool cut = false;                               // the scene ends at `last`, before them
  bool empty() const { return truth.empty() && images.empty() && last == TrueTime{}; }
  std::string thinned_words() const;  // a sentence about what is left out; empty if all is there
};

struct SceneLimits {
  std::size_t bytes = 720'000;  // as the page packs it (packed.h); base64 makes a megabyte of it
  TrueTime from{}, to{recording::scene::kReach_ns};
};

// Takes records in the order of MergedLogs::read(). Call finished() at the end.
class SceneSink final : public recording::scene::Moments {
 public:
  static constexpr Duration kSparsest = Duration::milliseconds(320);
  // Objects farther away are left out: only a damaged log has them.
  static constexpr double kFarthest_m = 10'000.0;

  // An instant's view needs the moments since kBefore and, for the truth in between, until kAfter.
  static constexpr Duration kBefore = Duration::milliseconds(2500), kAfter = Duration::milliseconds(1000);

  // `sensors`: by SensorId. Lists of other sensors are left out.
  SceneSink(std::vector<ViewedSensor> sensors, SceneLimits limits);
  Scene finished();

 private:
  void truth(TrueTime at, std::span<const recording::records::TruthState> states) override;
  void list(const recording::scene::SeenList& list) override;
  void image(TrueTime valid_at, const recording::records::ImageWritten& image) override;
  void use(TrueTime at, const recording::records::FeatureUsed& use) override;
  void odometry(SensorId sensor) override;

  bool takes(TrueTime at);
  template <class Part> void add(std::vector<Moment<Part>>& moments, Moment<Part> moment);
  void make_room();

  SceneLimits limits_;
  Scene scene_;
  std::size_t bytes_ = 0;
};

}  // namespace ttf::report::scene
