#include "sim/world/traffic/pace.h"

#include <algorithm>
#include <cmath>

namespace ttf::sim::world::traffic {

double Pace::size() const {
  constexpr double kUsual = 2.0;
  return std::abs(acceleration.value_or(kUsual));
}

double Pace::wanted(double now, double step) const {
  if (!speed) return acceleration.value_or(0.0);
  return std::clamp((*speed - now) / step, -size(), size());
}

Pace load_pace(YamlMap& yaml) {
  Pace pace;
  if (yaml.has("acceleration")) pace.acceleration = yaml.number("acceleration", {-20.0, 20.0}, "m/s^2");
  if (yaml.has("speed")) pace.speed = yaml.number("speed", {0.0, 100.0}, "m/s");
  return pace;
}

}  // namespace ttf::sim::world::traffic
