// Measures of a drive from its records alone: errors, tracking as a whole, ages, order of arrival and consistency.
//
// The sink sees a drive as its log does, so a live drive and its log have the same measures. Position and
// velocity are judged when the feature service uses an image: against the truth at that time, and against
// the DGPS reference interpolated to it.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/image_uses.h"
#include "evaluation/accuracy/reference_judge.h"
#include "evaluation/accuracy/tracking_judge.h"
#include "fusion/metrics/consistency.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

// The mean and the largest of a duration, with the number of samples.
struct AgeStatistics {
  std::uint64_t count = 0;
  Duration sum{};
  Duration worst{};
  void add(Duration age);
  Duration mean() const { return count == 0 ? Duration{} : Duration{sum.ns / static_cast<std::int64_t>(count)}; }
};

// A measure without any comparison is not a number, never a perfect zero.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Root mean squares over all matched objects and uses (evaluation/accuracy/box.h).
struct BoxErrors {
  double face_m = kNotMeasured;  // between the middles of the visible face
  double gap_m = kNotMeasured;
  double heading_rad = kNotMeasured;
  double speed_mps = kNotMeasured, acceleration_mps2 = kNotMeasured;  // along the heading
  double length_m = kNotMeasured, width_m = kNotMeasured;
};

// Normalised squares of the filter's own belief, each over its degrees of freedom: 1 if it judges itself rightly.
struct OwnJudgement {
  double position = kNotMeasured, velocity = kNotMeasured;
  // Only quantities that the motion model has count.
  double heading = kNotMeasured, speed = kNotMeasured, acceleration = kNotMeasured;
  double length = kNotMeasured, width = kNotMeasured;
  // Innovations of confirmed tracks, from the begin of the judged part on (NIS). The gate leaves out the largest, 0.3 % as
  // a rule, so that 0.98 is what a right filter has.
  double innovations = kNotMeasured;
  std::uint64_t innovation_degrees = 0;
};

struct DriveSummary {
  // Root mean square over all matched objects and uses; x, y [m], vx, vy [m/s].
  std::array<double, 4> rmse_truth{kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured};
  double position_rmse_truth = kNotMeasured;      // plane distance [m]
  double velocity_rmse_truth = kNotMeasured;      // plane velocity difference [m/s]
  double position_rmse_reference = kNotMeasured;  // against the DGPS [m]
  double velocity_rmse_reference = kNotMeasured;  // against the DGPS' Doppler velocity [m/s]
  std::uint64_t matched = 0;                      // objects at uses, compared with the truth
  std::uint64_t missed = 0;                       // true objects without an image's object within the gate
  std::uint64_t spurious = 0;                     // an image's objects without a true object within the gate
  // Left out of all the above: true objects out of view, and an image's objects on them (evaluation/accuracy/judged_objects.h).
  std::uint64_t out_of_view = 0, shown_out_of_view = 0;
  BoxErrors box;
  TrackingMeasures tracking;  // misses and false tracks included
  std::uint64_t reference_compared = 0;
  ReferenceWeights reference_weights;
  std::uint64_t uses = 0;        // images that the feature service used or refused
  std::uint64_t stale_uses = 0;  // uses that were refused: the image was too old
  // Normalised estimation error squared of (x, y, vx, vy) predicted to the use, averaged over the same pairs at
  // the first uses of images. The average lies in the band with 95 % if the samples are independent and the
  // model is right.
  double nees = kNotMeasured;
  std::uint64_t nees_samples = 0;
  double nees_low = kNotMeasured, nees_high = kNotMeasured;
  OwnJudgement own;  // over the same pairs
  // Age of a measurement when it was fused, and of each sensor's newest when its image was used.
  AgeStatistics age_fused;
  AgeStatistics age_used;
  std::map<SensorId, AgeStatistics> age_fused_by_sensor;
  std::map<SensorId, AgeStatistics> age_used_by_sensor;
  // The oldest and the newest of the latter at every use of an image, each as a distribution.
  recording::records::BinnedDurations age_used_oldest;
  recording::records::BinnedDurations age_used_newest;
  // Lists of observations over the whole drive.
  std::uint64_t received = 0;         // lists that the fusion node took in
  std::uint64_t out_of_sequence = 0;  // lists older than a list of an earlier fusion step
  std::uint64_t fused = 0;
  std::uint64_t fused_late = 0;  // fused after a younger list
  std::uint64_t held = 0;        // counts a list at every fusion instant that holds it
  AgeStatistics held_for;        // per such list: from its first hold until it was fused
  std::uint64_t dropped = 0;     // too old for the history
  std::uint64_t duplicates = 0;
  std::uint64_t odometry_samples = 0, odometry_stops = 0;  // samples taken in; times that no newer one came
  std::uint64_t warnings = 0;                              // uses with a warning about an object
  // Measures that need the scenario; other modules fill them in.
  double position_mse_reference_corrected =
      kNotMeasured;  // without the DGPS' own error (evaluation/accuracy/reference_judge.h)
  // Without sampling (experiments/sweep/expected_drive.h).
  double face_mse_expected = kNotMeasured, position_mse_expected = kNotMeasured;
};

class DriveMeasures final : public ImageUses {
 public:
  // Ignores uses before `from`, and after `until`. `until` is the end of a recording. `gate_m` is the largest distance of
  // matched objects, `cut_off` has the parameters of GOSPA and OSPA.
  explicit DriveMeasures(TrueTime from, double gate_m = kGate_m, std::optional<TrueTime> until = std::nullopt,
                         const fusion::metrics::CutOff& cut_off = {});

  // The judged part also ends at the instant that `end` returns, if any, such as that of a collision. A use at that instant counts.
  void end_with(std::function<std::optional<TrueTime>()> end) { end_ = std::move(end); }

  // Judges the last use and returns the summary. Call it once, at the end.
  DriveSummary finish();

  bool wants_frames() const override { return false; }
  using ImageUses::on;
  void on(const recording::records::FusionInput&) override;
  void on(const recording::records::OdometryTaken&) override;
  void on(const recording::records::ListFused&) override;
  void on(const recording::records::ReferenceFix&) override;

 private:
  void fused(SensorId sensor, Duration age) override;
  bool used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
            std::span<const SensorAge> ages) override;
  void judged(const JudgedUse& use) override;
  void note_box(const UsedObject& object);
  void note_belief(const Belief& belief);
  OwnJudgement own_judgement() const;
  void note_held(const recording::records::ListFused& list);
  void note_ages(std::span<const SensorAge> ages);

  bool is_judged(TrueTime at) const;

  TrueTime from_;
  std::optional<TrueTime> until_;
  std::function<std::optional<TrueTime>()> end_;
  DriveSummary summary_;
  std::array<double, 4> squares_{};
  BoxErrors box_squares_;  // sums of squares
  TrackingJudge tracking_;
  fusion::metrics::Consistency nees_, position_, velocity_, innovations_;
  ByQuantity<fusion::metrics::Consistency> quantities_;
  std::uint32_t receiving_step_ = 0;
  GlobalTime receiving_{};                                     // instant of that step
  std::optional<GlobalTime> newest_received_, newest_before_;  // before: in earlier steps
  struct Held {
    MeasurementId id;
    GlobalTime measured{}, since{};
  };
  static constexpr std::size_t kMostHeld = 64;  // more than any strategy holds
  std::deque<Held> held_;                       // the oldest first
  ReferenceJudge reference_;
};

}  // namespace ttf::evaluation::accuracy
