// What the tracker assumes about objects and sensors.
#pragma once

#include <cstddef>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "fusion/oosm/kind.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::fusion::config {

// How objects move (fusion/motion/): in straight lines at constant velocity or acceleration, along bends of constant
// turn rate at constant speed (CTRV) or acceleration (CTRA), or now at constant velocity and now along bends (CTRV), by
// interacting multiple models.
enum class MotionModel : unsigned char { kConstantVelocity, kConstantAcceleration, kCtrv, kCtra, kInteracting };
// How what is not linear is taken (fusion/filters/): to first order, or by sigma points. Where motion and measurement
// are linear, the extended filter is the Kalman filter, and so is the unscented one but for rounding.
enum class FilterKind : unsigned char { kExtended, kUnscented };

// What BUFF waits for (fusion/strategies/strategy.h).
enum class BuffWaiting : unsigned char {
  kSchedule,  // until the schedule says that nothing older can come
  kMeasured,  // until the longest delay that a sensor's lists have had so far is over; before the first, as kSchedule
  kFixedLag,  // fixed_lag behind the measurement, whatever has arrived
};

// What is done about errors of the sensors that are always the same and whose sigmas alone are known
// (fusion/sensors/known_sensor.h): nothing, or the Schmidt form (fusion/filters/consider.h), in which they are not
// estimated but remain in every track's covariance.
enum class SystematicErrorsAre : unsigned char { kIgnored, kConsidered };
// Which observation is of which track (docs/tracker.md): the one most probable way (fusion/association/assignment.h),
// or all of them weighed with their probabilities (fusion/association/joint_association.h).
enum class Association : unsigned char { kNearest, kJpda };
// When a track is believed: after M observations in N scans, or from the probability that its object exists
// (fusion/tracks/existence.h).
enum class Birth : unsigned char { kMOfN, kExistence };

struct TrackerConfig {
  MotionModel motion = MotionModel::kConstantVelocity;
  FilterKind filter = FilterKind::kExtended;
  // Spectral density of the white noise that drives each axis, on bends the speed along the heading: acceleration
  // [m^2/s^3], or jerk [m^2/s^5] for constant acceleration and CTRA. 3 m^2/s^3 lets the velocity wander by 1.7 m/s
  // within a second, a car that brakes or accelerates moderately.
  double process_noise = 3.0;
  // Of the turn acceleration [rad^2/s^3], for bends: 0.1 lets the turn rate wander by 0.3 rad/s within a second, a car
  // that turns into a side road.
  double turn_noise = 0.1;
  double mode_seconds = 5.0;                // interacting: how long an object keeps to one model, on the average
  double initial_velocity_sigma = 8.0;      // [m/s] of a new track, per axis
  double initial_acceleration_sigma = 2.0;  // [m/s^2]
  double initial_turn_rate_sigma = 0.3;     // [rad/s]
  double gate_probability = 0.9973;         // that the right observation is in its gate (three sigma in 1D)
  int confirm_hits = 3;                     // M of the last N scans confirm a track
  int confirm_window = 5;
  // Scans in a row without an observation after which an image calls a track coasting: one more than the
  // scans a faster sensor makes between two of a slower, which may be the only one to see the object.
  int coast_misses = 3;
  int delete_misses = 8;               // scans in a row without an observation end a confirmed track
  double delete_position_sigma = 5.0;  // [m] so does this much uncertainty
  // Where scans fail to come nothing counts them: a track is coasting, and ends, this long after its newest
  // observation, too (given_up() in fusion/tracks/track.h). Above what a fault-free image shows of an object that only
  // the slowest sensor sees, every other time; and as far ahead as a constant velocity is worth anything in traffic.
  Duration coast_after = Duration::milliseconds(300);
  Duration delete_after = Duration::milliseconds(1000);
  int max_objects = 25;               // confirmed tracks: what the image's list carries
  std::size_t max_observations = 64;  // in one list
  BuffWaiting buff_waits = BuffWaiting::kSchedule;
  Duration fixed_lag = Duration::milliseconds(100);
  std::size_t history_scans = 64;  // how far back a late scan can be taken in
  // How ADVA and TT take it in (fusion/strategies/late/late_updates.h). Other than rewind: for straight motion under
  // the extended filter only.
  oosm::Kind late = oosm::Kind::kRewind;
  double heading_noise = 0.05;  // spectral density of the heading's random walk [rad^2/s]
  double extent_noise = 0.01;   // of length and width [m^2/s]

  // With constant velocity or acceleration and the extended filter they may be considered.
  SystematicErrorsAre systematic = SystematicErrorsAre::kIgnored;
  // By SensorId; of those that are not there nothing is known. As load_tracker() reads them they are in the order of
  // the file: whoever knows the sensors' ids by their names puts them in theirs.
  std::vector<sensors::KnownSensor> sensors;

  Association association = Association::kNearest;
  Birth birth = Birth::kMOfN;
  // For jpda and existence: how probable it is that a list has an object that is tracked, of all the sensors whose
  // lists come; and how many observations of nothing there are to the square metre of one list
  // (fusion/tracks/existence.h).
  double detection_probability = 0.9;
  double clutter_density = 1e-3;  // [1/m^2]
  // For existence: of a new track; for how long an object is there, on the average; a track is confirmed from, and ends
  // below.
  double initial_existence = 0.1;
  double survival_seconds = 60.0;
  double confirm_existence = 0.99;
  double delete_existence = 0.01;
  // Two confirmed tracks that are apart by no more than this quantile, merge_scans lists in a row, are united
  // (fusion/tracks/twins.h); 0: never.
  double merge_probability = 0.0;
  int merge_scans = 5;
};

TrackerConfig load_tracker(YamlMap& yaml);

}  // namespace ttf::fusion::config
