// The expected error of one drive, from the instants that it had: when lists were measured, with which covariance, when
// they were fused, and when images were used. No estimate is looked at.
//
// The recursion of experiments/sweep/expected_error.h over these, with the scenario's process noise as assumed and the
// world's as actual. What is not in it: systematic errors of sensors and manoeuvres, which are no noise; associations,
// for of every list the observation next to the object is taken, within 4 m, and a list that has none says nothing;
// that a sensor's own noise may be another than the covariance it gives; what the bus rounds.
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
  // One object, and a tracker of constant velocity, in whose plane all that is measured is a position.
  static bool is_defined(const drives::Scenario& scenario);
  explicit ExpectedError(const drives::Scenario& scenario);

  // Expected square of the position's error [m^2] over the first uses of images from the scenario's evaluate_from on;
  // not a number where there are none.
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
  GlobalTime fusing_{};                               // instant of the newest list's fusion
  std::deque<recording::records::TruthState> truth_;  // the last few instants
  std::deque<Seen> seen_;     // of lists that are not fused yet: the observation next to the object
  std::deque<Image> images_;  // the last few
  double sum_ = 0.0;
  std::uint64_t uses_ = 0;
};

}  // namespace ttf::experiments::sweep
