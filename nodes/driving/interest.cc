#include "nodes/driving/interest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ttf::nodes::driving {
namespace {

constexpr double kClosest_m = 0.5;  // an object nearer than this fills the picture

// One axis of the picture: a span about the middle, grown and moved into -half..half.
struct Span {
  double low = 0.0, high = 0.0;
};
Span within(Span box, double half, double least) {
  const double middle = 0.5 * (box.low + box.high);
  const double reach = std::min(half, std::max(0.5 * (box.high - box.low), 0.5 * least));
  const double centre = std::clamp(middle, reach - half, half - reach);
  return {centre - reach, centre + reach};
}

}  // namespace

std::optional<vision::Region> region_of(const Picture& picture, const InterestConfig& config,
                                        const recording::records::ImageObject& object) {
  const double c = std::cos(picture.heading), s = std::sin(picture.heading);
  const double dx = object.x - picture.x, dy = object.y - picture.y;
  const double x = c * dx + s * dy, y = -s * dx + c * dy, turned = object.heading - picture.heading;
  const double along = std::cos(turned), across = std::sin(turned);
  double depth = std::numeric_limits<double>::infinity();
  Span columns{depth, -depth};
  for (const double l : {-0.5 * object.length, 0.5 * object.length})
    for (const double w : {-0.5 * object.width, 0.5 * object.width}) {
      const double ahead = x + l * along - w * across, aside = y + l * across + w * along;
      if (ahead < kClosest_m) return std::nullopt;
      depth = std::min(depth, ahead);
      const double column = -picture.focal_px * aside / ahead;
      columns = {std::min(columns.low, column), std::max(columns.high, column)};
    }
  Span rows{picture.focal_px * (picture.height_m - config.object_height_m) / depth,
            picture.focal_px * picture.height_m / depth};
  const double column = 0.5 * (columns.low + columns.high), row = 0.5 * (rows.low + rows.high);
  if (std::abs(column) > picture.half_width_px || std::abs(row) > picture.half_height_px) return std::nullopt;
  const auto widened = [&](Span box) { return Span{box.low - config.margin_px, box.high + config.margin_px}; };
  const double share = std::sqrt(config.least_area);
  columns = within(widened(columns), picture.half_width_px, 2.0 * share * picture.half_width_px);
  rows = within(widened(rows), picture.half_height_px, 2.0 * share * picture.half_height_px);
  return vision::Region{picture.sensor, columns.low, rows.low, columns.high - columns.low, rows.high - rows.low, true};
}

}  // namespace ttf::nodes::driving
