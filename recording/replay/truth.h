// The true states of recorded objects, from the truth beside their observations.
//
// An object is there from its first true position to its last, except in gaps above kLongestTruthGap. In between its
// state is interpolated linearly. A truth without a velocity has the slope of that line.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/time.h"
#include "fusion/metrics/identity.h"
#include "recording/rows/observation_rows.h"

namespace ttf::recording::replay {

inline constexpr Duration kLongestTruthGap = Duration::milliseconds(1000);

struct TrueObject {
  fusion::metrics::Named is;  // named by the place of its name in alphabetical order
  double vx = 0.0, vy = 0.0;  // [m/s]
};

class Truth {
 public:
  explicit Truth(const std::vector<recording::rows::ObservationRow>& rows);

  bool empty() const { return paths_.empty(); }
  // Returns the objects at an instant, in the order of their names.
  std::vector<TrueObject> at(GlobalTime instant) const;

 private:
  struct State {
    GlobalTime at{};
    double x = 0.0, y = 0.0;
    std::optional<std::array<double, 2>> velocity;
  };
  std::vector<std::vector<State>> paths_;  // by object, in the order of time, one state an instant
};

}  // namespace ttf::recording::replay
