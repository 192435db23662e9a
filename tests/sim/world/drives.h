// The worlds of the shipped drives, and worlds for tests made from text.
#pragma once

#include <string>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "sim/world/world.h"

namespace ttf::sim::world {

inline WorldConfig world_from(const std::string& text) {
  const StrictYaml yaml = StrictYaml::parse(text, "test.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  WorldConfig config = load_world(root);
  root.finish();
  findings.throw_if_any();
  return config;
}

// The world of "scenarios/<name>.yaml", with the drive's duration.
inline WorldConfig drive(const std::string& name) {
  const StrictYaml yaml = StrictYaml::load(TTF_SOURCE_DIR "/scenarios/" + name + ".yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  YamlMap map = root.map("world");
  WorldConfig config = load_world(map);
  map.finish();
  config.duration = root.duration("duration", {Duration{}, Duration::milliseconds(3'600'000)});
  findings.throw_if_any();
  return config;
}

inline WorldConfig without_noise(WorldConfig config) {
  config.acceleration_noise = config.yaw_rate_noise = 0.0;
  return config;
}

inline TrueTime at_ms(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }

}  // namespace ttf::sim::world
