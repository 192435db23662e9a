// The spread of a radar's returns over an outline, of which the mean of a few has its part.
//
// Returns lie evenly over the azimuths of the visible outline (sensors/radar/model.h). So the mean of n of them is the silhouette's
// (fusion/tracks/body/anchor.h), beside the noise with the covariance C / n. C is that of range, bearing and range rate over the
// outline: of 1.8 m across behind a car, of 4.4 m along beside it. A return of several merged echoes has less, by an unknown
// part.
//
// The outline is that of the track's box. C has a kink where the box is end-on: a rear alone has no spread of the range, and
// 0.05 rad on, the side gives it 0.6 m. So C is its mean over the uncertain heading, by Gauss and Hermite's rule of three points:
// C(h) 2 / 3 + (C(h - d) + C(h + d)) / 6, d = sqrt(3) sigma (Abramowitz, Stegun, table 25.10). C takes the turn rate as known.
// Where the heading is unknown, the box stands at an eighth of a turn to the line of sight, which shows both of its sides.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/mounted.h"
#include "fusion/tracks/body/body.h"

namespace ttf::fusion::tracks::body {

// A box as a sensor sees it: in the vehicle's axes, from the sensor's place.
struct SeenBox {
  linear::Vector<2> centre = linear::Vector<2>::Zero();  // [m]
  Box box;
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // the centre's, relative to the sensor [m/s]
  double turn_rate = 0.0;                                  // [rad/s]
};
// Returns the box of this body, seen from a sensor that is mounted so. Where the heading is unknown, the box stands at an eighth of a
// turn to the line of sight.
SeenBox seen_box(const Body& body, const estimators::Estimator& estimator, const sensors::Mounting& mounting);

// Returns C. Around the sensor there is no outline, and C is zero.
linear::Matrix<3> spread_of(const SeenBox& outline);

// Returns C over the outline of this track, seen from a sensor that is mounted so.
linear::Matrix<3> spread_of(const Body& body, const estimators::Estimator& estimator,
                            const sensors::Mounting& mounting);

// Returns the observation with C / n added; of one without returns, an equal one.
sensors::Observation with_spread(const sensors::Observation& observation, const linear::Matrix<3>& spread);
// The same, as one of this body.
sensors::Observation with_spread(const sensors::Observation& observation, const Body& body,
                                 const estimators::Estimator& estimator, const sensors::Mounting& mounting);
// The same, of an object that is new.
sensors::Observation with_spread(const sensors::Observation& observation, const Extent& extent);

// C of the tracks, for the observations of one list. C depends on the track and on the sensor, not on the observation. So it
// is computed once, however many observations are tried with the body.
class Spreads {
 public:
  explicit Spreads(std::size_t max_tracks) : of_track_(max_tracks) {}

  // Begins a list: forgets all of them.
  void begin() { ++list_; }
  // Forgets that of the index-th track of the set, since the track changes.
  void forget(std::size_t index) { of_track_[index].list = 0; }
  // Returns spread_of() to the bit. It is valid until the next call.
  const linear::Matrix<3>& of(std::size_t index, const Body& body, const estimators::Estimator& estimator,
                              const sensors::Mounting& mounting);

 private:
  struct OfTrack {
    std::uint64_t list = 0;  // the rest is for this list; 0: for none
    linear::Vector<2> position = linear::Vector<2>::Zero(), velocity = linear::Vector<2>::Zero();  // the sensor's
    linear::Matrix<3> spread = linear::Matrix<3>::Zero();
  };
  std::uint64_t list_ = 0;
  std::vector<OfTrack> of_track_;
};

}  // namespace ttf::fusion::tracks::body
