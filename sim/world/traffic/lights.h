// Traffic lights: they stand where a scenario puts them, and show their phases in turn.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/road/road.h"

namespace ttf::sim::world::traffic {

enum class Light : std::uint8_t { kDark, kRed, kRedYellow, kGreen, kYellow };

struct Phase {
  Light light = Light::kDark;
  Duration duration{};
};

struct LightConfig {
  std::string name;
  // Where it stands over ground. Its `heading` is the way it looks.
  double x = 0.0, y = 0.0, heading = 0.0;
  std::optional<road::OnLane> on;  // instead: above this stop line
  std::vector<Phase> phases;       // from the start of the drive on, again and again
};
LightConfig load_light(YamlMap& yaml, const road::RoadConfig* road);
// Returns a light above a stop line with its place over ground.
LightConfig placed(LightConfig light, const road::Road& road);

Light shown_at(const LightConfig& light, TrueTime since_start);
// Returns whether the light stops one who follows it.
bool stops(Light light);

}  // namespace ttf::sim::world::traffic
