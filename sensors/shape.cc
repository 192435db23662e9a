#include "sensors/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ttf::sensors {

std::array<Corner, 4> corners(const ObjectState& state) {
  const double c = std::cos(state.heading), s = std::sin(state.heading);
  const double l = 0.5 * state.length, w = 0.5 * state.width;
  const auto at = [&](double along, double across) {
    return Corner{state.x + c * along - s * across, state.y + s * along + c * across};
  };
  return {at(l, w), at(-l, w), at(-l, -w), at(l, -w)};
}

RayTarget::RayTarget(const ObjectState& state) : heading_(state.heading), half_{0.5 * state.length, 0.5 * state.width} {
  const double c = std::cos(state.heading), s = std::sin(state.heading);
  origin_[0] = -(c * state.x + s * state.y);
  origin_[1] = -(-s * state.x + c * state.y);
}

std::optional<double> RayTarget::ray_to(double azimuth) const {
  // The slab method.
  const double direction[] = {std::cos(azimuth - heading_), std::sin(azimuth - heading_)};
  double enter = 0.0, leave = 1e9;
  for (int k = 0; k < 2; ++k) {
    if (std::abs(direction[k]) < 1e-12) {
      if (std::abs(origin_[k]) > half_[k]) return std::nullopt;
      continue;
    }
    const double a = (-half_[k] - origin_[k]) / direction[k], b = (half_[k] - origin_[k]) / direction[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave || enter <= 0.0) return std::nullopt;
  return enter;
}

std::optional<AzimuthSpan> azimuth_span(const ObjectState& state) {
  const double middle = std::atan2(state.y, state.x);
  AzimuthSpan span{0, 0};
  for (const Corner& corner : corners(state)) {
    const double offset = std::remainder(std::atan2(corner.y, corner.x) - middle, 2.0 * std::numbers::pi);
    if (std::abs(offset) > 0.5 * std::numbers::pi) return std::nullopt;
    span.low = std::min(span.low, offset);
    span.high = std::max(span.high, offset);
  }
  return AzimuthSpan{middle + span.low, middle + span.high};
}

}  // namespace ttf::sensors
