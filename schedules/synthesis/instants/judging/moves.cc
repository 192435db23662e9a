#include "schedules/synthesis/instants/judging/moves.h"

#include <algorithm>
#include <utility>

#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/order.h"

namespace ttf::schedules::synthesis::instants::judging {

std::optional<Placed> placed_within(const Reading& reading, const Limits& limits, std::vector<Ticks> offsets) {
  const Problem& problem = reading.problem;
  Placed placed;
  for (std::size_t c = 0; c < problem.chains.size(); ++c) {
    const Ways found = ways(problem, problem.chains[c], offsets);
    if (found.longest > limit_of(problem, limits, c)) return std::nullopt;
    placed.ages.push_back(found.longest);
    placed.least.push_back(found.shortest);
  }
  if (fused_in_order(reading, offsets) != true || (limits.jitter && placed.jitter() > *limits.jitter))
    return std::nullopt;
  placed.solution.offsets = std::move(offsets);
  return placed;
}

Placed moved_measurements(const Reading& reading, const Limits& limits, Placed start,
                          const std::function<double(const std::vector<Ticks>& offsets)>& value, int most_moves,
                          int& moves) {
  const std::vector<Activity>& activities = reading.problem.activities;
  std::vector<std::size_t> sensors;
  for (const auto& sensor : reading.sensors)
    if (sensor && !activities[*sensor].fixed) sensors.push_back(*sensor);
  if (sensors.empty()) return start;
  Ticks step = 0;
  for (const std::size_t sensor : sensors) step = std::max(step, activities[sensor].period / 4);
  double best = value(start.solution.offsets);
  for (; step > 0; step /= 2)
    for (std::size_t i = 0, still = 0; still < sensors.size(); i = (i + 1) % sensors.size(), ++still)
      for (const Ticks by : {-step, step}) {
        if (moves >= most_moves) return start;
        std::vector<Ticks> offsets = start.solution.offsets;
        offsets[sensors[i]] = modulo(offsets[sensors[i]] + by, activities[sensors[i]].period);
        auto placed = placed_within(reading, limits, std::move(offsets));
        ++moves;
        if (!placed) continue;
        const double reached = value(placed->solution.offsets);
        if (reached >= best) continue;
        best = reached;
        start = std::move(*placed);
        still = 0;
      }
  return start;
}

}  // namespace ttf::schedules::synthesis::instants::judging
