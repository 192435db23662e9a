#include "evaluation/driving/lane_account.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ttf::evaluation::driving {

InLane TrueLane::place_of(const recording::records::EgoTruth& ego) const {
  const sim::world::road::LinePlace place = road_.place_of(ego.x + config_.front_axle_m * std::cos(ego.heading),
                                                           ego.y + config_.front_axle_m * std::sin(ego.heading));
  const double direction = sim::world::road::Road::direction(config_.lane);
  const double along = road_.line_at(place.station).pose.heading + (direction < 0.0 ? std::numbers::pi : 0.0);
  return {direction * (place.offset - road_.middle(config_.lane)),
          std::remainder(ego.heading - along, 2.0 * std::numbers::pi)};
}

bool TrueLane::left_by(const InLane& place) const {
  return std::abs(place.offset) + 0.5 * config_.width_m > 0.5 * config_.road.lane_width;
}

bool LaneAccount::judge(const recording::records::EgoTruth& ego) {
  const InLane place = lane_.place_of(ego);
  const bool outside = lane_.left_by(place);
  ++moments_;
  if (outside) ++outside_;
  sums_.offset_rms_m += place.offset * place.offset;
  sums_.heading_rms_rad += place.heading * place.heading;
  sums_.largest_offset_m = std::max(sums_.largest_offset_m, std::abs(place.offset));
  sums_.largest_heading_rad = std::max(sums_.largest_heading_rad, std::abs(place.heading));
  return outside;
}

LaneFindings LaneAccount::findings() const {
  LaneFindings found = sums_;
  const double moments = static_cast<double>(std::max<std::uint64_t>(1, moments_));
  found.offset_rms_m = std::sqrt(found.offset_rms_m / moments);
  found.heading_rms_rad = std::sqrt(found.heading_rms_rad / moments);
  found.outside = static_cast<double>(outside_) / moments;
  return found;
}

}  // namespace ttf::evaluation::driving
