#include "sim/world/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ttf::world {

std::array<Corner, 4> corners(const ObjectState& state) {
  const double c = std::cos(state.heading), s = std::sin(state.heading);
  const double l = 0.5 * state.length, w = 0.5 * state.width;
  const auto at = [&](double along, double across) {
    return Corner{state.x + c * along - s * across, state.y + s * along + c * across};
  };
  return {at(l, w), at(-l, w), at(-l, -w), at(l, -w)};
}

std::optional<double> ray_to(const ObjectState& state, double azimuth) {
  // In the object's frame the outline is a box: the slab method.
  const double c = std::cos(state.heading), s = std::sin(state.heading);
  const double ox = -(c * state.x + s * state.y), oy = -(-s * state.x + c * state.y);
  const double dx = std::cos(azimuth - state.heading), dy = std::sin(azimuth - state.heading);
  double enter = 0.0, leave = 1e9;
  const double origin[] = {ox, oy}, direction[] = {dx, dy}, half[] = {0.5 * state.length, 0.5 * state.width};
  for (int k = 0; k < 2; ++k) {
    if (std::abs(direction[k]) < 1e-12) {
      if (std::abs(origin[k]) > half[k]) return std::nullopt;
      continue;
    }
    const double a = (-half[k] - origin[k]) / direction[k], b = (half[k] - origin[k]) / direction[k];
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

}  // namespace ttf::world
