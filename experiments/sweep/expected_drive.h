// The expected errors of one drive, from its instants alone: when lists were measured, with which covariance,
// when they were fused, and when images were used. They use no estimate.
//
//   face      The point that the track follows, the one that sensors see (fusion/tracks/body/anchor.h), by the recursion of
//             expected_error.h. The scenario's process noise is assumed, and the world's is actual, with its memory.
//   position  The centre, half of the hidden side behind it: half of the length, if a rear is in view. That side's error
//             is the same in every image (expected_size.h). Sizes are as drawn. Seen widths correct the length as far
//             as the prior correlates both. The heading's error swings the centre about the face. The heading
//             is that of course and measured axis, each by its certainty (expected_heading.h).
//
// A laser's end and a camera's silhouette are one point as long as one face alone is in view. The tracker takes the
// silhouette's mean depth for a mean range, which is w^2 / (24 range) more for a face of width w: 0.014 m for 1.8 m at
// 10 m. The value leaves that out. A turned car of unknown size shows different points, and has no value. If its size is
// known, the value leaves out the heading.
//
// A tracker with classes has no value: its prior changes with the measurements.
//
// It leaves out systematic errors of sensors and manoeuvres, which are no noise, and the bus' rounding. It takes a
// sensor's covariance for its true noise. Instead of an association it takes every list's observation next to the
// object's outline, within 4 m. A list without one is ignored. So fields of view need no model here: a sensor that cannot
// see the object has no observation of it.
#pragma once

#include <cstdint>
#include <deque>
#include <numbers>
#include <optional>
#include <vector>

#include "evaluation/accuracy/box.h"
#include "experiments/sweep/expected_error.h"
#include "experiments/sweep/expected_heading.h"
#include "experiments/sweep/expected_size.h"
#include "recording/records/records.h"
#include "sim/drives/scenario.h"

namespace ttf::experiments::sweep {

class ExpectedError final : public recording::records::Sink {
 public:
  // Returns whether the scenario has one object and a tracker of constant velocity, to which sizes are constants. All
  // measurements are then positions in its plane. Besides, the object shows all sensors one face alone at the start, whatever
  // size is drawn, or the tracker has its nominal size.
  static bool is_defined(const sim::drives::Scenario& scenario);
  ExpectedError(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster);

  // Return the expected squares of the errors [m^2] of the visible face's middle and of the centre. They are over the first
  // uses of images from the scenario's evaluate_from on; not a number if there are none.
  double face_mse() const { return mean_of(face_sum_); }
  double position_mse() const { return mean_of(position_sum_); }

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::TruthState&) override;
  void on(const recording::records::ObservationSeen&) override;
  void on(const recording::records::ListFused&) override;
  void on(const recording::records::ImageWritten&) override;
  void on(const recording::records::FeatureUsed&) override;

 private:
  struct Seen {
    MeasurementId id;
    GlobalTime measured{};
    double distance = 0.0;  // from the true outline [m]
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
    double heading = 0.0, speed = 0.0;  // the true ones [rad, m/s]
  };
  struct Image {
    std::uint32_t sequence = 0;
    double face = 0.0, position = 0.0;  // expected squares [m^2]
  };
  double mean_of(double sum) const;
  sensors::Shows shows(const Seen& seen) const;
  std::optional<SizeLook> size_seen(const Seen& seen) const;
  SizeLook face_seen(const Seen& seen) const;
  std::optional<SizeLook> silhouette_seen(const Seen& seen, const sensors::Placement& place, double focal_px,
                                          double width_sigma_px) const;
  void take_axis(const Seen& seen);
  // The estimated heading: the variance that the tracker believes [rad^2], the derivative by the velocity across [s/m], and
  // the part of measured axes in the square of the error [rad^2].
  struct Facing {
    double variance = std::numbers::pi * std::numbers::pi / 3.0;
    double by_velocity = 0.0, by_axis = 0.0;
  };
  Facing facing(GlobalTime at, double heading, double speed) const;
  // Returns what the heading's error adds to the square of the centre's.
  double swing(const Eigen::Matrix4d& error, GlobalTime at) const;
  // 0 if the length is along the line of sight, 1 if the width is; and the other one.
  Eigen::Index hidden() const;
  Eigen::Index shown() const { return 1 - hidden(); }
  double half_hidden() const { return 0.5 * prior_.mean(hidden()); }

  sensors::kinds::Sensors sensors_;
  fusion::config::TrackerConfig tracker_;
  std::vector<schedules::model::Sensor> of_cluster_;  // by SensorId
  SizeMoments drawn_, prior_;
  evaluation::accuracy::Face face_;  // in view at the start
  bool alone_;                       // no other one is in view
  TrueTime from_;
  PointMotion motion_;
  ErrorRecursion recursion_;
  SizeRecursion size_;
  HeadingRecursion heading_;
  GlobalTime fusing_{};                               // instant at which the newest list was fused
  std::deque<recording::records::TruthState> truth_;  // the last few instants
  std::deque<Seen> seen_;                             // in lists not fused yet: the observation next to the object
  std::deque<Image> images_;                          // the last few
  double face_sum_ = 0.0, position_sum_ = 0.0;
  std::uint64_t uses_ = 0;
};

}  // namespace ttf::experiments::sweep
