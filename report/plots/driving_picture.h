// A closed loop over time, from the records of a drive: the gap to the object ahead, the speeds of both, and the
// vehicle's acceleration. Lines are the truth. Marks are the services' view, and the acceleration asked of the
// actuator. The place in the lane is shown if a service keeps it, and the lengths of sequences if cameras share a
// detector.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/sheet.h"
#include "report/drawing/svg.h"

namespace ttf::report::plots {

struct PlaceInLane {
  double offset = 0.0, heading = 0.0;  // [m], [rad]
};

struct DrivingOptions {
  std::string title{};
  TrueTime from{}, to{};
  double front_m = 3.4, width_m = 1.8;  // the vehicle's front, ahead of its rear axle
  // Returns the vehicle's true place in the lane that it keeps; empty if it keeps none.
  std::function<PlaceInLane(const recording::records::EgoTruth&)> lane{};
};

class DrivingPicture final : public recording::records::Sink {
 public:
  explicit DrivingPicture(DrivingOptions options) : options_(std::move(options)) {}

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::EgoTruth&) override;
  void on(const recording::records::TruthState&) override;
  void on(const recording::records::CommandIssued&) override;
  void on(const recording::records::CommandTaken&) override;
  void on(const recording::records::Warning&) override;
  void on(const recording::records::PlanMade&) override;
  void on(const recording::records::SequencePlanned&) override;

  std::string svg(const drawing::Sheet& sheet = {}) const;

 private:
  using Points = std::vector<drawing::Point>;  // seconds, value
  bool shown(TrueTime at) const { return at >= options_.from && at <= options_.to; }
  void end_moment();

  DrivingOptions options_;
  Points gap_, speed_, speed_ahead_, acceleration_;       // the truth
  Points offset_, heading_;                               // likewise; degrees
  Points seen_gap_, seen_speed_, seen_ahead_, asked_;     // by services and actuator
  Points sequence_, bound_;                               // lengths of sequences of detections, and their bounds
  std::optional<TrueTime> planned_at_;                    // the newest sequence
  std::vector<std::pair<double, std::size_t>> warnings_;  // their begins, with the service
  std::optional<recording::records::EgoTruth> ego_;
  std::optional<double> collided_at_;    // [s]; no gap is shown behind it
  std::optional<drawing::Point> ahead_;  // gap and speed of the nearest object in the way
};

}  // namespace ttf::report::plots
