// Compares used images with the DGPS reference as the fixes come in.
//
// A use is judged once a fix on either side of it is known. Position and, if the receiver measured it, velocity
// are interpolated between the two fixes and compared with the estimate nearest to that position. Only the two
// newest fixes and the uses since then are kept, so memory and time do not grow with the drive.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "evaluation/accuracy/plane.h"
#include "recording/records/records.h"
#include "sim/world/reference.h"

namespace ttf::evaluation::accuracy {

// The parts of an interpolated fix, averaged over the compared uses. With the share s of the later fix they are
// (1 - s)^2 + s^2, 2 s (1 - s), and the square of the distance from the sensor car [m^2].
struct ReferenceWeights {
  double squares = 0.0, products = 0.0, range_squared = 0.0;
};

// Returns the expected square of the interpolated reference's error, for a receiver with these known errors:
//   (2 sigma^2 + m^2 P) squares + m^2 C products + 2 (sigma / baseline)^2 range_squared
// Noise is independent from fix to fix. An excursion of size m begins at a fix with probability p and lasts for
// n fixes. It is present with P = 1 - (1 - p)^n, and the same one at two consecutive fixes with C = (1 - p) (1
// - (1 - p)^(n - 1)). The alignment's error is one for the whole drive (sim/world/reference.h), to the first
// order. Assumptions: n fixes have come before. The error is independent of the estimate's; the object's curved
// way between two fixes breaks this by at most density period^3 / 48 [m^2]. No use was left out because its
// estimate and the reference are far apart.
double expected_square(const sim::world::ReferenceConfig& reference, const ReferenceWeights& weights);

class ReferenceJudge {
 public:
  // An estimate further from the reference than `gate_m` [m] is not of its object.
  explicit ReferenceJudge(double gate_m) : gate_(gate_m) {}

  // Both are called in the order of time, each by itself. A use before the older of the two newest fixes is too
  // late to be judged.
  void fix(const recording::records::ReferenceFix& fix);
  void use(TrueTime at, std::span<const PlaneEstimate> estimates);

  std::uint64_t compared() const { return compared_; }
  // Root mean squares over the compared uses, NaN if there are none. The velocity counts if both fixes have
  // one.
  double position_rmse() const;      // [m]
  double velocity_rmse() const;      // [m/s]
  ReferenceWeights weights() const;  // zeros if no use was compared
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Use {
    TrueTime at;
    std::vector<PlaneEstimate> estimates;
  };
  void judge(const Use& use);

  double gate_;
  std::optional<recording::records::ReferenceFix> before_, after_;  // after_ is the newest
  std::deque<Use> waiting_;
  std::uint64_t compared_ = 0, velocities_ = 0;
  double position_squares_ = 0.0, velocity_squares_ = 0.0;
  ReferenceWeights sums_;
};

}  // namespace ttf::evaluation::accuracy
