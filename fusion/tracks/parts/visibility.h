// How visible objects are to a sensor: the probability that a list of it could contain the object of a track.
//
// It is the product of
//   - the probability that the object lies in the sensor's field (fusion/sensors/known_sensor.h). The sensor looks for the middle
//     of the object, at the range of its near side. Edges are soft. The variance of the bearing is that of the position,
//     across the line of sight and over the squared range, plus w^2 / 12. Here w is the angle that the object fills: which
//     part of it the sensor needs is unknown. The variance of the range is made likewise.
//     The same holds for the edges of blind sectors.
//   - for every confirmed track that is nearer, the probability that it does not hide the middle. A track hides what lies
//     on a line of sight that has passed its outline. With births by existence this counts by its probability to exist.
//     An outline that holds the other track's centre hides nothing: the two are one object.
// A sensor without a known field sees everything.
//
// A tentative track is visible to the sensor that observed it last: it was seen there, wherever that is. Otherwise clutter
// beyond a field would live for long.
//
// With births m_of_n a list counts for a track if it has an observation of it or sees it with more than kCounts.
//
// The lines of sight are taken by their bearing. The outlines that the present one may meet are kept by their distance. So
// n tracks take about n log n steps. The result depends on nothing but the tracks, the sensor and the configuration. The
// constructor allocates all storage.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Visibility {
 public:
  static constexpr double kCounts = 0.5;

  Visibility(const config::TrackerConfig& config, std::size_t max_tracks);

  // Judges the tracks, predicted to a list of this sensor. With observation_of (by track, -1 for none), only tracks without
  // an observation are judged; any other is visible. `vehicle` is the list's (fusion/sensors/observation.h).
  void judge(const std::vector<Track>& tracks, const estimators::Estimator& estimator, SensorId sensor,
             std::span<const int> observation_of = {}, const std::optional<sensors::Mounting>& vehicle = {});
  // Returns the visibility of a track that was judged last.
  double of(std::size_t track) const { return sees_all_ ? 1.0 : visible_[track]; }
  // Returns whether the list counts against such a track if it has no observation of it.
  bool counts(std::size_t track) const { return of(track) > kCounts; }

 private:
  // A line of sight to the middle of an object, from the sensor in the axes of the tracks.
  struct Sight {
    double bearing = 0.0;   // [rad], -pi..pi
    double range = 0.0;     // [m], to the centre
    double variance = 0.0;  // the bearing's [rad^2]
    std::size_t track = 0;
  };
  // An outline that hides what is behind it, between the bearings low <= high. Both may be a turn off.
  struct Outline {
    double low = 0.0, high = 0.0, variance = 0.0;
    double crossed_from = 0.0, crossed_to = 0.0;  // by lines of sight of these bearings
    double range = 0.0;                           // [m], to its centre
    double exists = 1.0;
    linear::Vector<2> centre, axis, half;  // from the sensor; along the length; half of length and width [m]
    std::size_t track = 0;
  };
  void add_sight(const Track& track, std::size_t index, const estimators::Estimator& estimator);
  void add_outline(const Track& track, std::size_t index, const estimators::Estimator& estimator);
  void hide();
  double hidden(const Sight& sight, const Outline& outline) const;

  std::vector<sensors::KnownSensor> sensors_;
  bool by_existence_;
  const sensors::KnownSensor* sensor_ = nullptr;  // the present one
  sensors::Mounting from_;                        // its place at the list's instant
  bool sees_all_ = true;
  std::vector<double> visible_;          // by track
  std::vector<Sight> sights_;            // to tracks in the field, by bearing
  std::vector<Outline> outlines_;        // by crossed_from
  std::vector<const Outline*> crossed_;  // those near the present line of sight, by range
};

}  // namespace ttf::fusion::tracks::parts
