// The expected error of one drive, from its instants alone: when lists were measured, with which covariance,
// when they were fused, and when images were used. It uses no estimate.
//
// It applies the recursion of experiments/sweep/expected_error.h, with the scenario's process noise as assumed
// and the world's as actual. It leaves out systematic errors of sensors and manoeuvres, which are no noise, and
// the bus' rounding. It takes a sensor's covariance for its true noise. Instead of an association it takes
// every list's observation next to the object, within 4 m; a list without one is ignored.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "drives/scenario.h"
#include "experiments/sweep/expected_error.h"
#include "recording/records/records.h"

namespace ttf::experiments::sweep {

class ExpectedError final : public recording::records::Sink {
 public:
  // Returns whether the scenario has one object, and a tracker of constant velocity. All measurements are then
  // positions in its plane.
  static bool is_defined(const drives::Scenario& scenario);
  explicit ExpectedError(const drives::Scenario& scenario);

  // Returns the expected square of the position's error [m^2] over the first uses of images from the scenario's
  // evaluate_from on; not a number if there are none.
  double position_mse() const;

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
    double distance = 0.0;  // from the truth [m]
    Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  };
  struct Image {
    std::uint32_t sequence = 0;
    double square = 0.0;  // expected [m^2]
  };

  TrueTime from_;
  PointMotion motion_;
  ErrorRecursion recursion_;
  GlobalTime fusing_{};                               // instant at which the newest list was fused
  std::deque<recording::records::TruthState> truth_;  // the last few instants
  std::deque<Seen> seen_;                             // in lists not fused yet: the observation next to the object
  std::deque<Image> images_;                          // the last few
  double sum_ = 0.0;
  std::uint64_t uses_ = 0;
};

}  // namespace ttf::experiments::sweep
