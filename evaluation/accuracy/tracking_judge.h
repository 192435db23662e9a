// Judges the tracks of a drive as a whole: GOSPA, OSPA, CLEAR-MOT and the lives of the objects (fusion/metrics/). Errors
// of pairs get better when a poorly tracked object is missed. Here a miss costs, as the members say.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "fusion/metrics/clear_mot.h"
#include "fusion/metrics/set_distance.h"
#include "fusion/metrics/track_life.h"

namespace ttf::evaluation::accuracy {

// Over all judged instants. A distance is the p-th root of the mean p-th power [m]. Its parts are means of p-th powers
// [m^p], and add up to its p-th power. Without an instant they are not a number.
struct TrackingMeasures {
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

  fusion::metrics::CutOff cut_off;
  double gate_m = 0.0;  // the gate of matches
  std::uint64_t instants = 0;
  // A missed object costs c^p / 2. So no estimate is worse than one within c / 2^(1/p): 2.8 m for c = 4 m, p = 2. One
  // farther off counts as worse than none.
  fusion::metrics::Gospa gospa{kNothing, kNothing, kNothing, kNothing};
  // A missed object costs up to c^p. A false track can make up for it.
  fusion::metrics::Ospa ospa{kNothing, kNothing, kNothing};
  // MOTA counts every miss; MOTP is over the matches only.
  fusion::metrics::ClearMotCounts mot;
  // An object's life begins at the first judged instant that has it. Every miss lowers the fraction tracked.
  fusion::metrics::LifeSummary lives;
};

class TrackingJudge {
 public:
  // Objects and tracks further apart than `gate_m` [m] are no match for CLEAR-MOT and the lives.
  TrackingJudge(const fusion::metrics::CutOff& cut_off, double gate_m);

  // Judges an instant. One that is not later than the last is left out. CLEAR-MOT and the lives see the first of a
  // repeated name.
  void judge(TrueTime at, std::span<const fusion::metrics::Named> objects,
             std::span<const fusion::metrics::Named> tracks);
  TrackingMeasures measures() const;

 private:
  double gate_;
  std::optional<TrueTime> last_;
  std::uint64_t instants_ = 0;
  fusion::metrics::Gospa gospa_;  // sums
  fusion::metrics::Ospa ospa_;
  fusion::metrics::SetMetric metric_;
  fusion::metrics::ClearMot mot_;
  fusion::metrics::TrackLives lives_;
  // One instant.
  std::vector<fusion::metrics::Point> points_[2];
  std::vector<fusion::metrics::Named> named_[2];
  std::vector<fusion::metrics::Identity> objects_;
};

}  // namespace ttf::evaluation::accuracy
