#include "fusion/metrics/near_pairs.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace ttf::fusion::metrics {
namespace {

constexpr std::size_t kFew = 1024;  // pairs, up to which trying all is cheaper

}  // namespace

std::span<const NearPair> NearPairs::find(std::span<const Point> rows, std::span<const Point> columns,
                                          double within_m) {
  within_ = within_m;
  found_.clear();
  if (rows.size() * columns.size() <= kFew || !(within_m > 0.0))
    try_all(rows, columns);
  else
    try_near(rows, columns);
  return found_;
}

void NearPairs::try_all(std::span<const Point> rows, std::span<const Point> columns) {
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c) try_one(rows, columns, r, c);
}

// Sorts the second set into squares, and tries those around each point of the first. Rounding moves a position by half
// of a square. Beyond that, only equal positions are within the distance. So pairs are at most two squares apart.
void NearPairs::try_near(std::span<const Point> rows, std::span<const Point> columns) {
  const auto square = [this](double position) { return std::floor(position / within_); };
  const auto before = [](const Place& a, const Place& b) {
    return std::tie(a.column, a.row, a.point) < std::tie(b.column, b.row, b.point);
  };
  places_.clear();
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (!std::isnan(columns[c].x) && !std::isnan(columns[c].y))
      places_.push_back({square(columns[c].x), square(columns[c].y), c});
  std::sort(places_.begin(), places_.end(), before);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double column = square(rows[r].x), row = square(rows[r].y);
    if (std::isnan(column) || std::isnan(row)) continue;
    double last = std::numeric_limits<double>::quiet_NaN();
    for (double by = -2.0; by <= 2.0; ++by) {
      if (column + by == last) continue;  // huge numbers round to the same column
      last = column + by;
      auto place = std::lower_bound(places_.begin(), places_.end(), Place{last, row - 2.0, 0}, before);
      for (; place != places_.end() && place->column == last && place->row <= row + 2.0; ++place)
        try_one(rows, columns, r, place->point);
    }
  }
}

void NearPairs::try_one(std::span<const Point> rows, std::span<const Point> columns, std::size_t row,
                        std::size_t column) {
  // Bounds each axis on its own, no tighter than rounding: that excludes most pairs cheaply.
  const double reach = within_ * (1.0 + 1e-9);
  const double dx = rows[row].x - columns[column].x, dy = rows[row].y - columns[column].y;
  if (std::abs(dx) > reach || std::abs(dy) > reach) return;
  const double distance = std::hypot(dx, dy);
  if (distance <= within_) found_.push_back({row, column, distance});
}

}  // namespace ttf::fusion::metrics
