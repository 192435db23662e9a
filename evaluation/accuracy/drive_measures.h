// What a drive was worth: errors, ages, order of arrival and consistency, from its records alone.
//
// A sink: it sees the run as the log does, so measures of a live run and of its log are the same. Position and velocity
// are judged where they matter, at the instants the feature service used the image, against the truth at that true time
// and against the DGPS reference interpolated to it.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/image_uses.h"
#include "evaluation/accuracy/reference_judge.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

// Mean and largest of a duration, with the number of samples.
struct AgeStatistics {
  std::uint64_t count = 0;
  Duration sum{};
  Duration worst{};
  void add(Duration age);
  Duration mean() const { return count == 0 ? Duration{} : Duration{sum.ns / static_cast<std::int64_t>(count)}; }
};

// What was compared with nothing is not a number, never a perfect zero.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct DriveSummary {
  // Root mean square over all matched objects and uses; x, y [m], vx, vy [m/s].
  std::array<double, 4> rmse_truth{kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured};
  double position_rmse_truth = kNotMeasured;      // of the plane distance [m]
  double velocity_rmse_truth = kNotMeasured;      // of the plane velocity difference [m/s]
  double position_rmse_reference = kNotMeasured;  // against the DGPS [m]
  double velocity_rmse_reference = kNotMeasured;  // against the DGPS' Doppler velocity [m/s]
  std::uint64_t matched = 0;                      // object uses compared with the truth
  std::uint64_t missed = 0;                       // true objects without an image within the gate
  std::uint64_t spurious = 0;                     // image objects without a true object within the gate
  std::uint64_t reference_compared = 0;
  ReferenceWeights reference_weights;
  std::uint64_t uses = 0;        // times the feature service used an image, or refused one
  std::uint64_t stale_uses = 0;  // of them refused: the image was too old
  // Normalised estimation error squared of (x, y, vx, vy) predicted to the use, averaged over the same pairs at first
  // uses of an image, and the band in which the average lies with 95 % if the samples are independent and the model is
  // right.
  double nees = kNotMeasured;
  std::uint64_t nees_samples = 0;
  double nees_low = kNotMeasured, nees_high = kNotMeasured;
  // Age of a measurement when it was fused, and of the newest of each sensor when its image was used.
  AgeStatistics age_fused;
  AgeStatistics age_used;
  std::map<SensorId, AgeStatistics> age_fused_by_sensor;
  std::map<SensorId, AgeStatistics> age_used_by_sensor;
  // Of these, at every use of an image: the oldest and the newest, each as a distribution.
  recording::records::BinnedDurations age_used_oldest;
  recording::records::BinnedDurations age_used_newest;
  // Observation lists over the whole drive.
  std::uint64_t received = 0;         // lists the fusion node took in
  std::uint64_t out_of_sequence = 0;  // of them older than one taken in before
  std::uint64_t fused = 0;
  std::uint64_t fused_late = 0;  // retrodicted
  std::uint64_t held = 0;        // fusion instants at which a list was kept back
  AgeStatistics held_for;        // of each such list: from the first of them until it was fused
  std::uint64_t dropped = 0;     // too old for the history
  std::uint64_t duplicates = 0;
  std::uint64_t warnings = 0;  // uses in which an object warned
  // What only who knows the scenario can say: filled in by others.
  double position_mse_reference_corrected =
      kNotMeasured;                             // less the DGPS' own error (evaluation/accuracy/reference_judge.h)
  double position_mse_expected = kNotMeasured;  // without sampling (experiments/sweep/expected_drive.h)
};

class DriveMeasures final : public ImageUses {
 public:
  // Uses before `from` are not judged; image and truth further apart than `gate_m` do not belong together.
  explicit DriveMeasures(TrueTime from, double gate_m = kGate_m);

  // Completes what waits for its truth. Call once, at the end.
  DriveSummary finish();

  bool wants_frames() const override { return false; }
  using ImageUses::on;
  void on(const recording::records::FusionInput&) override;
  void on(const recording::records::ListFused&) override;
  void on(const recording::records::ReferenceFix&) override;

 private:
  void fused(SensorId sensor, Duration age) override;
  bool used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
            std::span<const SensorAge> ages) override;
  void judged(const JudgedUse& use) override;
  void note_held(const recording::records::ListFused& list);
  void note_ages(std::span<const SensorAge> ages);

  TrueTime from_;
  DriveSummary summary_;
  std::array<double, 4> squares_{};
  double nees_sum_ = 0.0;
  std::uint32_t receiving_step_ = 0;
  GlobalTime receiving_{};                                     // instant of that step
  std::optional<GlobalTime> newest_received_, newest_before_;  // before: in earlier steps
  struct Held {
    MeasurementId id;
    GlobalTime measured{}, since{};
  };
  static constexpr std::size_t kMostHeld = 64;  // more than any strategy keeps
  std::deque<Held> held_;                       // the first was first
  ReferenceJudge reference_;
};

}  // namespace ttf::evaluation::accuracy
