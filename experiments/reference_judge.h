// Used images against the DGPS reference, as the fixes come in.
//
// A use is judged once a fix on either side of it is known: position and, where the receiver measured it, velocity are
// interpolated between the two, and compared with the estimate nearest to that position. Only the two newest fixes and the
// uses since are kept, so that memory and time do not grow with the drive.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::experiments {

// In the plane; [m] and [m/s].
struct PlaneEstimate {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;
};

class ReferenceJudge {
 public:
  // An estimate further from the reference than `gate_m` [m] is not of its object.
  explicit ReferenceJudge(double gate_m) : gate_(gate_m) {}

  // Both in the order of time among themselves; a use before the older of the two newest fixes is too late to be judged.
  void fix(const records::ReferenceFix& fix);
  void use(TrueTime at, std::span<const PlaneEstimate> estimates);

  std::uint64_t compared() const { return compared_; }
  // Root mean squares over the uses compared, NaN where there are none. The velocity counts where both fixes have one.
  double position_rmse() const;   // [m]
  double velocity_rmse() const;   // [m/s]
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Use {
    TrueTime at;
    std::vector<PlaneEstimate> estimates;
  };
  void judge(const Use& use);

  double gate_;
  std::optional<records::ReferenceFix> before_, after_;   // the newest is after_
  std::deque<Use> waiting_;
  std::uint64_t compared_ = 0, velocities_ = 0;
  double position_squares_ = 0.0, velocity_squares_ = 0.0;
};

}  // namespace ttf::experiments
