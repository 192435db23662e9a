// Judges a replay's tracks by the recording's truth, after every fusion.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "evaluation/accuracy/tracking_judge.h"
#include "fusion/metrics/cut_off.h"
#include "fusion/tracks/view.h"
#include "recording/replay/truth.h"

namespace ttf::cli::track {

struct TrackAccuracy {
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  double position_rmse_m = kNothing, velocity_rmse_mps = kNothing;  // over the pairs
  std::uint64_t compared = 0, missed = 0, spurious = 0;             // objects at all instants
  evaluation::accuracy::TrackingMeasures tracking;
};

class TrackJudge {
 public:
  TrackJudge(const std::vector<recording::rows::ObservationRow>& rows, const fusion::metrics::CutOff& cut_off);

  // Takes the tracks as they are known from `known` on. The last ones of an instant count.
  void take(GlobalTime known, std::span<const fusion::tracks::TrackView> tracks);
  // Returns nothing if the recording has no truth. Call it once, at the end.
  std::optional<TrackAccuracy> finish();

 private:
  struct Shown {
    GlobalTime known{}, at{};
    std::vector<fusion::metrics::Named> tracks;
    std::vector<std::array<double, 2>> velocities;
  };
  void judge(const Shown& shown);

  recording::replay::Truth truth_;
  evaluation::accuracy::TrackingJudge judge_;
  std::optional<Shown> waiting_;
  TrackAccuracy sums_;
  double position_squares_ = 0.0, velocity_squares_ = 0.0;
};

}  // namespace ttf::cli::track
