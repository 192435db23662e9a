// The detections of a detector that several cameras share: how long its frames last, and how often it looks at the
// camera that it looks at most. It uses the records alone.
//
// An interval lies between the beginnings of two successive detections of a camera, primary or secondary
// (schedules/sequence/detections.h). A drive has one such detector.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"

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

}  // namespace ttf::evaluation::driving
