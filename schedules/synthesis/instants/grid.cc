#include "schedules/synthesis/instants/grid.h"

#include <algorithm>
#include <numeric>

namespace ttf::schedules::synthesis::instants {

Ticks latest_on_grid(const Grid& grid, Ticks latest) {
  const Ticks within = modulo(latest, grid.period), start = latest - within;
  const Ticks last = grid.first + (grid.last - grid.first) / grid.step * grid.step;
  if (within < grid.first) return start - grid.period + last;
  return start + std::min(last, grid.first + (within - grid.first) / grid.step * grid.step);
}

Ticks next_on_grid(const Grid& grid, Ticks earliest) {
  const Ticks within = modulo(earliest, grid.period), start = earliest - within;
  if (within <= grid.first) return start + grid.first;
  const Ticks at = grid.first + (within - grid.first + grid.step - 1) / grid.step * grid.step;
  return at <= grid.last ? start + at : start + grid.period + grid.first;
}

Ticks in_the_way(const Activity& one, Ticks at, const Activity& other, Ticks there, bool earlier) {
  const Ticks common = common_period(one, other);
  const Ticks behind = modulo(at - there, common);  // from the other's beginning to this one's
  const bool overlaps = behind < other.duration || common - behind < one.duration;
  if (!overlaps || one.duration == 0 || other.duration == 0) return 0;
  // Earlier: it ends where the other begins. Later: it begins where the other ends.
  if (earlier) return behind < other.duration ? behind + one.duration : one.duration - (common - behind);
  return behind < other.duration ? other.duration - behind : common - behind + other.duration;
}

}  // namespace ttf::schedules::synthesis::instants
