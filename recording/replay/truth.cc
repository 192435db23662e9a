#include "recording/replay/truth.h"

#include <algorithm>
#include <map>

namespace ttf::recording::replay {

// The first row of an instant counts.
Truth::Truth(const std::vector<recording::rows::ObservationRow>& rows) {
  std::map<std::string, std::map<GlobalTime, State>> by_name;
  for (const recording::rows::ObservationRow& row : rows)
    if (row.truth) {
      const GlobalTime at{row.time_ns};
      by_name[row.truth->object].try_emplace(at, State{at, row.truth->x, row.truth->y, row.truth->velocity});
    }
  for (const auto& [name, states] : by_name)
    for (std::vector<State>& path = paths_.emplace_back(); const auto& [at, state] : states) path.push_back(state);
}

std::vector<TrueObject> Truth::at(GlobalTime instant) const {
  std::vector<TrueObject> objects;
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    const std::vector<State>& path = paths_[p];
    const auto after = std::lower_bound(path.begin(), path.end(), instant,
                                        [](const State& state, GlobalTime when) { return state.at < when; });
    if (after == path.end() || (after == path.begin() && after->at != instant)) continue;
    const State& b = *after;
    const State& a = after == path.begin() ? b : *std::prev(after);
    const double h = (b.at - a.at).seconds();
    if (b.at != instant && b.at - a.at > kLongestTruthGap) continue;
    const double s = h > 0.0 ? (instant - a.at).seconds() / h : 1.0;
    TrueObject& object = objects.emplace_back();
    object.is = {static_cast<fusion::metrics::Identity>(p), {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}};
    const double slope_x = h > 0.0 ? (b.x - a.x) / h : 0.0, slope_y = h > 0.0 ? (b.y - a.y) / h : 0.0;
    const std::array<double, 2> before = a.velocity.value_or(std::array{slope_x, slope_y}),
                                behind = b.velocity.value_or(std::array{slope_x, slope_y});
    object.vx = before[0] + s * (behind[0] - before[0]);
    object.vy = before[1] + s * (behind[1] - before[1]);
  }
  return objects;
}

}  // namespace ttf::recording::replay
