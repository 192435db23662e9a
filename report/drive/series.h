// Series and distributions of a drive's records, for the report's plots and tables: errors at each use of an
// image, ages of measurements, precision, corrections, problems and faults.
//
// The class is a sink. It pairs objects as evaluation/accuracy/drive_measures.h does: an image's and true
// objects within the gate, at least cost.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/faults/injected_fault.h"
#include "fusion/metrics/point.h"
#include "recording/records/records.h"

namespace ttf::report::drive {

struct TimedValue {
  double t_s = 0.0, value = 0.0;
};

struct DriveSeries {
  std::vector<TimedValue> position_error;  // [m] at each use of an image: root mean square over the objects matched
  std::vector<TimedValue> velocity_error;  // [m/s]
  std::vector<TimedValue> newest_age;      // [ms] of the newest measurement in an image, at its use
  std::vector<TimedValue> oldest_age;      // [ms] of the sensor with the oldest list in the image
  std::map<SensorId, std::vector<double>> age_fused, age_used;                              // [ms]
  std::vector<TimedValue> precision;                                                        // [us]
  std::map<NodeId, std::vector<TimedValue>> offset_corrections;                             // microticks
  std::map<NodeId, std::map<recording::records::SlotStatus, std::uint64_t>> slot_problems;  // count by status
  std::map<std::pair<NodeId, std::uint8_t>, std::uint64_t> deadlines_missed;                // by task
  std::map<std::uint32_t, evaluation::faults::InjectedFault> faults;                        // by index in the plan
  std::map<std::string, std::uint64_t> guardian;  // interventions of central guardians by reason
  std::uint64_t missed = 0, spurious = 0, matched = 0;
  double end_s = 0.0;  // the end of the last task
};

class DriveSeriesSink final : public recording::records::Sink {
 public:
  explicit DriveSeriesSink(double gate_m = 4.0) : gate_m_(gate_m) {}
  DriveSeries finish();

  using recording::records::Sink::on;
  void on(const recording::records::ListFused& r) override;
  void on(const recording::records::ImageWritten& r) override;
  void on(const recording::records::FeatureUsed& r) override;
  void on(const recording::records::TruthState& r) override;
  void on(const recording::records::PrecisionSample& r) override;
  void on(const recording::records::ClockCorrected& r) override;
  void on(const recording::records::SlotProblem& r) override;
  void on(const recording::records::TaskRun& r) override;
  void on(const recording::records::FaultActivity& r) override { series_.faults[r.fault].take(r); }
  void on(const recording::records::GuardianIntervention& r) override;

 private:
  struct State {
    double x, y, vx, vy;
    operator fusion::metrics::Point() const { return {x, y}; }
  };
  struct Fused {
    MeasurementId id;
    TrueTime measured{};
  };
  struct Image {
    std::uint32_t sequence;
    std::vector<Fused> newest;
  };
  struct Use {
    TrueTime at;
    std::vector<State> objects;
  };
  void judge_age(std::uint32_t image, TrueTime used);
  void judge(const Use& use);

  double gate_m_;
  DriveSeries series_;
  std::map<SensorId, Fused> newest_fused_;
  std::deque<Image> images_;    // the newest few
  std::optional<Use> pending_;  // waits for its truth
  std::vector<State> truth_;
  TrueTime truth_at_{};
  NodeId truth_node_{};
};

// Thins to at most `most` values: keeps the largest magnitude of each group of neighbours, so that extremes stay.
std::vector<TimedValue> thinned(const std::vector<TimedValue>& all, std::size_t most);

}  // namespace ttf::report::drive
