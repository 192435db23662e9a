// The true objects that a set of sensors could measure at an instant.
//
// An object is in view of a sensor if a ray from the sensor meets its outline
//   V1  in the field (fusion/sensors/known_sensor.h): within the half angle, in no blind sector, within the ranges, and
//   V2  unhidden: a nearer outline hides all behind it, up to the share `shadow` of its own distance.
// A part of the outline is enough, and one sensor is enough. Nothing is drawn: an object whose echoes are weak is in view. A sensor within
// an outline does not see that object. It sees through it.
//
// The rays part the plane into sectors. Their edges are the ends of outlines and of blind sectors. An outline that crosses an end of the
// ranges has edges there, too. All rays of a sector meet the same outlines in the same order, unless outlines overlap.
// So the middle of a sector decides. Another ray goes to the middle of each object. Cameras look there. The end of a finite
// shadow may lie within a sector. These rays decide there, too. n objects take about n log n steps, and one for each outline
// that a ray meets.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/sensors/known_sensor.h"
#include "sensors/device.h"
#include "sensors/scene.h"
#include "sensors/shape.h"

namespace ttf::sensors {

struct SensorView {
  Placement placement;
  fusion::sensors::Field field;
};

class InView {
 public:
  // Allocates for that many objects.
  InView(std::vector<SensorView> sensors, std::size_t most_objects);
  // Returns for each object, in the vehicle's axes, whether it is in view. Valid until the next call.
  std::span<const char> of(std::span<const ObjectState> objects);

 private:
  // An outline's part within the half angle: low <= middle <= high [rad].
  struct Silhouette {
    double low, middle, high;
    std::size_t object;
    RayTarget target;
  };
  struct Meeting {
    double range;
    std::size_t object;
  };
  void look(const SensorView& sensor, std::span<const ObjectState> objects);
  double add_unseen(const fusion::sensors::Field& field, std::size_t object);
  void add_hiding(double farthest);
  bool add_silhouette(std::size_t object, const AzimuthSpan& span, double from, double to);
  void cut_at_range(double range, const ObjectState& object);
  void aim_at_middles();
  void aim_at_sectors(const fusion::sensors::Field& field);
  void cast(const fusion::sensors::Field& field);
  void note(const fusion::sensors::Field& field);
  bool any_unseen() const;

  std::vector<SensorView> sensors_;  // those that nothing hides from come first: they are the cheapest
  std::size_t most_;
  std::vector<char> seen_;
  // In one sensor's axes:
  std::vector<ObjectState> objects_;
  std::vector<Silhouette> silhouettes_;  // by their lower ends
  std::vector<double> cuts_, rays_;      // [rad], ascending
  std::vector<std::size_t> crossed_;     // silhouettes that hold the present ray
  std::vector<Meeting> met_;             // by the present ray
};

}  // namespace ttf::sensors
