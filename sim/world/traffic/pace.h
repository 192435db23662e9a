// The acceleration that a segment says: a value, or one that leads to a speed.
#pragma once

#include <optional>

#include "core/strict_yaml.h"

namespace ttf::sim::world::traffic {

struct Pace {
  std::optional<double> acceleration;  // [m/s^2]
  std::optional<double> speed;         // [m/s], to be reached by an acceleration of that size, of either sign

  bool is_said() const { return acceleration || speed; }
  // Returns the acceleration towards a speed.
  double size() const;
  // Returns the acceleration of the `step` [s] that begins at the speed `now`; zero, if nothing is said.
  double wanted(double now, double step) const;
};
// Reads `acceleration` and `speed`.
Pace load_pace(YamlMap& yaml);

}  // namespace ttf::sim::world::traffic
