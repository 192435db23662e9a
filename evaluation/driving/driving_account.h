// The worth of a drive in which commands drive the vehicle: gap and time to collision, braking and jerk, commands, and the warnings
// of its services against the truth. It uses the records alone, and the road.
//
// Forward collision warning and emergency braking have a hazard when the true time to collision is below the service's
// time. Lane departure has one when a side of the vehicle is beyond its mark. Blind spot warning has one when an
// object's outline is in the zone of that side.
//
// The truth is judged at the instants at which it is recorded, some hundred a second. Instants within 10 us of each other
// are one: several nodes report it by their clocks. The object ahead is the nearest one whose
// outline overlaps the vehicle's way, a circle of its speed and yaw rate. A drive is judged up to its first collision.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/driving/warning_account.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "sim/world/road/road.h"

namespace ttf::evaluation::driving {

// Mean and deviation of durations [s], of which the squares are summed about the first one.
class Spread {
 public:
  void add(Duration duration);
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  std::uint64_t count() const { return count_; }
  double mean() const;       // kNone without a sample
  double deviation() const;  // by the sum of squares over count - 1; kNone for less than two

 private:
  std::uint64_t count_ = 0;
  double first_ = 0.0, sum_ = 0.0, squares_ = 0.0;
};

struct DetectionFindings {
  std::uint64_t primary = 0, secondary = 0;
  Spread frames;
  SensorId camera = kNoSensor;  // the one with the most detections
  Spread intervals;             // its
};

// The detections of a detector that several cameras share: how long its frames last, and how often it looks at the
// camera that it looks at most.
//
// An interval lies between the beginnings of two successive detections of a camera, primary or secondary
// (schedules/sequence/detections.h). A drive has one such detector.
class DetectionAccount final : public recording::records::Sink {
 public:
  // Ignores all before `from`.
  explicit DetectionAccount(TrueTime from) : from_(from) {}
  // Returns nothing without a detection.
  std::optional<DetectionFindings> finish() const;

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::DetectionMade&) override;
  void on(const recording::records::SequencePlanned&) override;

 private:
  struct Camera {
    std::optional<TrueTime> last;
    std::uint64_t detections = 0;
    Spread intervals;
  };
  TrueTime from_;
  DetectionFindings findings_;
  std::optional<TrueTime> frame_;      // the beginning of the newest one
  std::array<Camera, 256> cameras_{};  // by SensorId
};

struct LaneConfig {
  sim::world::road::RoadConfig road;
  int lane = -1;
  double front_axle_m = 2.58;  // ahead of the rear one
  double width_m = 1.8;        // the vehicle's
};

// A vehicle's place in its lane, by the truth: the offset of the front axle's middle, and the heading.
struct InLane {
  double offset = 0.0;   // [m], to the left of the lane's middle
  double heading = 0.0;  // [rad], from the lane's direction
};

class TrueLane {
 public:
  explicit TrueLane(const LaneConfig& config) : config_(config), road_(config.road) {}
  InLane place_of(const recording::records::EgoTruth& ego) const;
  // Returns whether a side of the vehicle is beyond its mark.
  bool left_by(const InLane& place) const;

 private:
  LaneConfig config_;
  sim::world::road::Road road_;
};

struct LaneFindings {
  double offset_rms_m = 0.0, largest_offset_m = 0.0;
  double heading_rms_rad = 0.0, largest_heading_rad = 0.0;
  double outside = 0.0;  // share of the moments in which a side is beyond its mark
};

class LaneAccount {
 public:
  explicit LaneAccount(const LaneConfig& config) : lane_(config) {}
  // Returns whether the vehicle leaves its lane at this moment.
  bool judge(const recording::records::EgoTruth& ego);
  LaneFindings findings() const;

 private:
  TrueLane lane_;
  LaneFindings sums_;  // squares, until the end
  std::uint64_t moments_ = 0, outside_ = 0;
};

// Beside the vehicle: from behind its rear axle to ahead of it, and off its side [m]. Both sides have the same.
struct BlindSpotZone {
  double ahead_m = 1.4, behind_m = 4.1, nearest_m = 0.5, furthest_m = 3.0;
};

struct DrivingConfig {
  double front_m = 3.4, width_m = 1.8;            // the vehicle's front, ahead of its rear axle
  double time_gap_s = 1.5, standstill_m = 2.0;    // the gap that it is to keep
  double reaction_speed_mps = 27.0;               // the object ahead falls below it, in truth and in the image
  std::array<double, 2> hazard_time_s{2.7, 1.6};  // by service: a hazard is a time to collision below this
  std::optional<LaneConfig> lane{};               // if a service keeps one
  std::optional<BlindSpotZone> blind_spot{};      // if a service watches it
  bool warns_ahead = true;                        // a service warns of collisions, or brakes
  std::optional<Duration> reads_every{};          // the period of the actuator's task, if it is known
  // The smallest admissible gap [m] at a speed; null: none.
  double (*minimum_gap)(double speed) = nullptr;
};

struct DrivingFindings {
  static constexpr double kNone = Spread::kNone;
  std::uint64_t moments = 0;       // at which the truth was judged
  double smallest_gap_m = kNone;   // 0: a collision
  double smallest_ttc_s = kNone;   // for constant speeds
  double gap_error_rms_m = kNone;  // behind an object, against standstill + time gap * speed
  double below_minimum = kNone;    // share of the moments behind an object
  double largest_deceleration = 0.0, largest_jerk = 0.0, jerk_rms = 0.0;  // [m/s^2], [m/s^3]
  struct Collision {
    TrueTime at{};
    double closing_mps = 0.0;
  };
  std::optional<Collision> collision;
  // The way from the instant at which the object ahead brakes until the vehicle stands [m].
  std::optional<double> stopping_distance_m;
  // From the instant at which the object ahead truly falls below the reaction speed until an image says so.
  std::optional<Duration> reaction;
  std::optional<DetectionFindings> detections;  // if cameras share a detector
  // Commands; readings of the actuator, by verdict.
  std::uint64_t issued = 0, applied = 0, none_new = 0, invalid = 0, late = 0, nothing_asked = 0, weaker = 0;
  std::array<WarningFindings, recording::records::kWarningKinds> warnings;  // by service
  std::optional<LaneFindings> lane;
  bool warns_ahead = false, watches_blind_spot = false;
  // How much later or earlier a reading of commands came than the one before it, against the cluster's time. In virtual
  // time only clocks differ. Readings between which the node lost the cluster's time are none.
  recording::records::BinnedDurations reading_jitter;
};

class DrivingAccount final : public recording::records::Sink {
 public:
  // Ignores all before `from`.
  DrivingAccount(const DrivingConfig& config, TrueTime from);
  // Call it once, at the end.
  DrivingFindings finish();
  // Returns the first instant so far at which the truth has a collision.
  std::optional<TrueTime> collided_at() const;

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::EgoTruth&) override;
  void on(const recording::records::TruthState&) override;
  void on(const recording::records::TaskRun&) override;
  void on(const recording::records::PowerChanged&) override;
  void on(const recording::records::ImageWritten&) override;
  void on(const recording::records::DetectionMade& r) override { detections_.on(r); }
  void on(const recording::records::SequencePlanned& r) override { detections_.on(r); }
  void on(const recording::records::CommandIssued&) override;
  void on(const recording::records::CommandTaken&) override;
  void on(const recording::records::Warning&) override;

 private:
  struct Ahead {
    double gap = 0.0, speed = 0.0, acceleration = 0.0;
    ObjectId object{};
  };
  void judge();
  void note_braking(double acceleration);
  void note_slowing();
  void note_reaction(TrueTime image);
  void note_hazards(double time_to_collision);
  void note_jerk();
  void note_beside(const recording::records::TruthState& object);
  void note_jitter(const recording::records::CommandTaken& taken);

  DrivingConfig config_;
  TrueTime from_;
  DrivingFindings findings_;
  DetectionAccount detections_;
  std::optional<recording::records::EgoTruth> ego_;  // the moment whose objects come
  std::optional<Ahead> ahead_;
  std::optional<recording::records::EgoTruth> before_, jerk_from_;
  std::optional<double> braking_way_;  // since the object ahead braked
  struct Leader {
    ObjectId object{};
    TrueTime ahead_at{};          // when it was last in the way
    std::optional<double> speed;  // at this moment
  };
  std::optional<Leader> fast_;           // the last object ahead that was fast, unless another one has come between
  std::optional<TrueTime> slow_at_;      // it fell below the reaction speed
  std::optional<TrueTime> stated_slow_;  // the first image since the moment that says so
  std::uint64_t behind_ = 0, below_ = 0, jerks_ = 0;
  double gap_squares_ = 0.0, jerk_squares_ = 0.0;
  WarningAccount warnings_;
  std::optional<LaneAccount> lane_;
  std::array<bool, 2> beside_{};                   // an object in the blind spot: left, right
  std::optional<recording::records::Stamp> read_;  // when the actuator last read commands, in global time
  bool has_own_time_ = false;                      // the actuator's local time is another than the cluster's
};

}  // namespace ttf::evaluation::driving
