// The tracker's assumptions about objects and sensors.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.h"
#include "fusion/config/classes.h"
#include "fusion/ego/odometry.h"
#include "fusion/oosm/kind.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::fusion::config {

// The motion of objects (fusion/motion/). It is straight at constant velocity or acceleration, or along bends
// of constant turn rate at constant speed (CTRV) or acceleration (CTRA). Or interacting multiple models combine
// constant velocity and CTRV.
enum class MotionModel : unsigned char { kConstantVelocity, kConstantAcceleration, kCtrv, kCtra, kInteracting };
// The treatment of nonlinear models (fusion/filters/): to first order, or by sigma points. For linear motion
// and measurements the extended filter is the Kalman filter, and the unscented filter equals it up to rounding.
enum class FilterKind : unsigned char { kExtended, kUnscented };

// The condition for which BUFF waits (fusion/strategies/strategy.h).
enum class BuffWaiting : unsigned char {
  kSchedule,  // until the schedule excludes older lists
  kMeasured,  // for the longest delay of the sensor's lists so far; before the first list as kSchedule
  kFixedLag,  // until fixed_lag after the measurement, whatever has arrived
};

// The treatment of the sensors' constant errors, of which only the sigmas are known
// (fusion/sensors/known_sensor.h). They are ignored, or the Schmidt filter (fusion/filters/consider.h) keeps
// them in every track's covariance without estimating them.
enum class SystematicErrorsAre : unsigned char { kIgnored, kConsidered };
// The association of observations with tracks (docs/fusion/tracker.md): the most probable one
// (fusion/association/assignment.h), or all, weighted by their probabilities
// (fusion/association/joint_association.h).
enum class Association : unsigned char { kNearest, kJpda };
// The confirmation of tracks: after M observations in N lists, or from the probability that the object exists
// (fusion/tracks/parts/existence.h).
enum class Birth : unsigned char { kMOfN, kExistence };

struct TrackerConfig {
  MotionModel motion = MotionModel::kConstantVelocity;
  FilterKind filter = FilterKind::kExtended;
  // Spectral density of the white noise that drives each axis, or on bends the speed along the heading:
  // acceleration [m^2/s^3], or jerk [m^2/s^5] for constant acceleration and CTRA. 3 m^2/s^3 lets the velocity
  // wander by 1.7 m/s within a second: a car brakes or accelerates moderately.
  double process_noise = 3.0;
  // The same for the noise across the vehicle's x axis, of constant velocity and acceleration alone. Absent: as along it. A
  // vehicle with odometry turns its axes, so that it has none.
  // Cars on a straight road ahead brake harder than they leave their lane.
  std::optional<double> cross_noise;
  double noise_across() const { return cross_noise.value_or(process_noise); }
  // Spectral density of the turn acceleration on bends [rad^2/s^3]. 0.1 lets the turn rate wander by 0.3 rad/s
  // within a second: a car turns into a side road.
  double turn_noise = 0.1;
  double mode_seconds = 5.0;                // [s] interacting: mean time until a mode is drawn anew
  double initial_velocity_sigma = 8.0;      // [m/s] of a new track, per axis
  double initial_acceleration_sigma = 2.0;  // [m/s^2]
  double initial_turn_rate_sigma = 0.3;     // [rad/s]
  double gate_probability = 0.9973;         // for the right observation to be in its gate (three sigma in 1D)
  int confirm_hits = 3;                     // M of the last N lists confirm a track
  int confirm_window = 5;
  // An image calls a track coasting after so many lists in a row without an observation. Where no field of a sensor is
  // known, a slower one may be the only one to see the object. So the value exceeds by one the lists of a faster sensor
  // between two of its own.
  int coast_misses = 3;
  int delete_misses = 8;               // so many lists in a row without an observation end a confirmed track
  double delete_position_sigma = 5.0;  // [m] so does a larger uncertainty
  // Missing lists count for no track. So a track also coasts, and ends, this long after its newest observation
  // (given_up() in fusion/tracks/track.h). The first value exceeds the largest age in an image without faults,
  // for an object that only the slowest sensor sees, every other time. The second is the longest useful
  // prediction at constant velocity in traffic.
  Duration coast_after = Duration::milliseconds(300);
  Duration delete_after = Duration::milliseconds(1000);
  int max_objects = 25;               // confirmed tracks; the image's list carries no more
  std::size_t max_observations = 64;  // in one list
  BuffWaiting buff_waits = BuffWaiting::kSchedule;
  Duration fixed_lag = Duration::milliseconds(100);
  std::size_t history_scans = 64;  // lists that a late list can reach back
  // The method by which ADVA and TT take late lists in (fusion/strategies/late/late_updates.h). Methods other
  // than rewind require straight motion and the extended filter.
  oosm::Kind late = oosm::Kind::kRewind;
  // Spectral density of the heading's random walk [rad^2/s], beside its turn rate (fusion/tracks/body/heading.h).
  double heading_noise = 0.005;
  Sizes sizes;  // without classes, those of all objects
  // An object is of one of them: of the first one while nothing of it is measured.
  std::vector<ClassPrior> classes;
  // A report names another class than the true one with this probability. Reports count as independent, though those of one
  // sensor repeat their errors: choose it larger than the sensor's own.
  double class_confusion = 0.05;
  double extent_noise = 0.0;  // spectral density of a random walk of length and width [m^2/s]
  // The sensors' vehicle moves, and its odometry has these errors: tracks live in the odometry frame (fusion/ego/ego_path.h).
  // Absent: tracks live in the vehicle's axes.
  std::optional<ego::OdometryErrors> odometry;
  double drift_density() const { return odometry ? odometry->drift_density() : 0.0; }

  // kConsidered requires constant velocity or acceleration and the extended filter.
  SystematicErrorsAre systematic = SystematicErrorsAre::kIgnored;
  // By SensorId; a missing sensor has no mounting, field or errors. The loader (fusion/loading/tracker.h) returns
  // them in the order of the file, and its caller reorders them by id.
  std::vector<sensors::KnownSensor> sensors;

  Association association = Association::kNearest;
  Birth birth = Birth::kMOfN;
  // For jpda and existence (fusion/tracks/parts/existence.h): the probability that a list contains a tracked object which its
  // sensor can see (fusion/tracks/parts/visibility.h). The second value is the number of clutter observations per square metre of
  // one list.
  double detection_probability = 0.9;
  double clutter_density = 1e-3;  // [1/m^2]
  // For existence: the existence of a new track; an object's mean lifetime; the thresholds of confirmation and
  // of deletion.
  double initial_existence = 0.1;
  double survival_seconds = 60.0;
  double confirm_existence = 0.99;
  double delete_existence = 0.01;
  // Two confirmed tracks within this quantile of each other, merge_scans lists in a row, are united
  // (fusion/tracks/parts/twins.h); 0: never.
  double merge_probability = 0.0;
  int merge_scans = 5;
  // The less certain one of two confirmed tracks in one place ends (fusion/tracks/parts/overlaps.h). Absent: both are kept,
  // unless the lists are recorded scans.
  std::optional<bool> end_overlaps;
  // Where the file has these keys, for findings about the cluster or the recording; 0: nowhere.
  int cross_noise_line = 0, odometry_line = 0;
};

}  // namespace ttf::fusion::config
