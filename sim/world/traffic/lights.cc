#include "sim/world/traffic/lights.h"

#include <numbers>

namespace ttf::sim::world::traffic {

LightConfig load_light(YamlMap& yaml, const road::RoadConfig* road) {
  LightConfig light;
  light.name = yaml.text("name");
  if (auto on = yaml.map_if("at")) {
    if (road == nullptr) yaml.fail("at", "needs a road in the world");
    light.on = road::load_on_lane(*on, road != nullptr ? *road : road::kMissingRoad);
  } else {
    light.x = yaml.number("x", {-10'000.0, 10'000.0}, "m");
    light.y = yaml.number("y", {-10'000.0, 10'000.0}, "m");
    light.heading = yaml.number_or("heading", std::numbers::pi, {-7.0, 7.0}, "rad");
  }
  for (YamlMap& map : yaml.maps("phases")) {
    Phase phase;
    phase.light = map.choice<Light>("light", {{"red", Light::kRed},
                                              {"red_yellow", Light::kRedYellow},
                                              {"green", Light::kGreen},
                                              {"yellow", Light::kYellow},
                                              {"dark", Light::kDark}});
    phase.duration = map.duration("duration", {Duration::milliseconds(100), Duration::milliseconds(3'600'000)});
    map.finish();
    light.phases.push_back(phase);
  }
  if (light.phases.empty()) yaml.fail("phases", "must have one phase or more");
  yaml.finish();
  return light;
}

LightConfig placed(LightConfig light, const road::Road& road) {
  if (!light.on) return light;
  const road::Pose pose = road.pose_at({light.on->station, road.middle(light.on->lane)});
  light.x = pose.x;
  light.y = pose.y;
  light.heading = pose.heading + (road::Road::direction(light.on->lane) > 0.0 ? std::numbers::pi : 0.0);
  return light;
}

Light shown_at(const LightConfig& light, TrueTime since_start) {
  Duration round{};
  for (const Phase& phase : light.phases) round = round + phase.duration;
  if (round.ns <= 0) return Light::kDark;
  std::int64_t within = since_start.ns < 0 ? 0 : since_start.ns % round.ns;
  for (const Phase& phase : light.phases) {
    if (within < phase.duration.ns) return phase.light;
    within -= phase.duration.ns;
  }
  return Light::kDark;
}

bool stops(Light light) {
  switch (light) {
    case Light::kRed:
    case Light::kRedYellow:
    case Light::kYellow: return true;
    case Light::kDark:
    case Light::kGreen: break;
  }
  return false;
}

}  // namespace ttf::sim::world::traffic
