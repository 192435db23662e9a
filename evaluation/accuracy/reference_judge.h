// Used images against the DGPS reference, as the fixes come in.
//
// A use is judged once a fix on either side of it is known: position and, where the receiver measured it, velocity are
// interpolated between the two, and compared with the estimate nearest to that position. Only the two newest fixes and
// the uses since are kept, so that memory and time do not grow with the drive.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "evaluation/accuracy/closest_pairs.h"
#include "recording/records/records.h"
#include "sim/world/reference.h"

namespace ttf::evaluation::accuracy {

// What an interpolated fix is made of, on the average over the uses compared: with the share s of the later fix, (1 -
// s)^2 + s^2 and 2 s (1 - s), and the square of the distance from the sensor car [m^2].
struct ReferenceWeights {
  double squares = 0.0, products = 0.0, range_squared = 0.0;
};

// The expected square of the error of what is interpolated, for a receiver of these errors that everybody who looks at
// it knows:
//   (2 sigma^2 + m^2 P) squares + m^2 C products + 2 (sigma / baseline)^2 range_squared
// Noise is independent from fix to fix. An excursion of size m that begins at a fix with probability p and lasts for n
// of them is there with P = 1 - (1 - p)^n, and the same at two fixes in a row with C = (1 - p) (1 - (1 - p)^(n - 1)).
// The alignment's error is one for the whole drive (sim/world/reference.h), to the first order. Assumed: that n fixes
// have been before; that the error has nothing to do with the estimate's, which is so but for the way that the object
// does not go straight between two fixes, at most density period^3 / 48 [m^2]; and that no use was left out because its
// estimate and the reference are far apart.
double expected_square(const sim::world::ReferenceConfig& reference, const ReferenceWeights& weights);

class ReferenceJudge {
 public:
  // An estimate further from the reference than `gate_m` [m] is not of its object.
  explicit ReferenceJudge(double gate_m) : gate_(gate_m) {}

  // Both in the order of time among themselves; a use before the older of the two newest fixes is too late to be
  // judged.
  void fix(const recording::records::ReferenceFix& fix);
  void use(TrueTime at, std::span<const PlaneEstimate> estimates);

  std::uint64_t compared() const { return compared_; }
  // Root mean squares over the uses compared, NaN where there are none. The velocity counts where both fixes have one.
  double position_rmse() const;      // [m]
  double velocity_rmse() const;      // [m/s]
  ReferenceWeights weights() const;  // zeros where nothing was compared
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Use {
    TrueTime at;
    std::vector<PlaneEstimate> estimates;
  };
  void judge(const Use& use);

  double gate_;
  std::optional<recording::records::ReferenceFix> before_, after_;  // the newest is after_
  std::deque<Use> waiting_;
  std::uint64_t compared_ = 0, velocities_ = 0;
  double position_squares_ = 0.0, velocity_squares_ = 0.0;
  ReferenceWeights sums_;
};

}  // namespace ttf::evaluation::accuracy
