#include "recording/replay/config.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "core/errors.h"
#include "core/file_kind.h"
#include "fusion/loading/known_sensor.h"
#include "fusion/loading/tracker.h"

namespace ttf::recording::replay {
namespace {

struct SigmaName {
  const char* name;
  double SensorNoise::*member;
  Range<double> allowed;
  const char* unit;
};
constexpr std::array<SigmaName, 7> kSigmas{{{"position", &SensorNoise::position, kSigmaAllowed, "m"},
                                            {"range", &SensorNoise::range, kSigmaAllowed, "m"},
                                            {"bearing", &SensorNoise::bearing, kAngleSigmaAllowed, "rad"},
                                            {"range_rate", &SensorNoise::range_rate, kSigmaAllowed, "m/s"},
                                            {"heading", &SensorNoise::heading, kAngleSigmaAllowed, "rad"},
                                            {"length", &SensorNoise::length, kSigmaAllowed, "m"},
                                            {"width", &SensorNoise::width, kSigmaAllowed, "m"}}};

SensorSetup load_sensor(YamlMap& yaml, SensorSetup setup) {
  for (const SigmaName& sigma : kSigmas)
    setup.noise.*sigma.member = yaml.number_or(sigma.name, setup.noise.*sigma.member, sigma.allowed, sigma.unit);
  if (yaml.has("worst_delay")) setup.worst_delay = yaml.duration("worst_delay", kDelayAllowed);
  if (yaml.has("period")) setup.period = yaml.duration("period", kPeriodAllowed);
  constexpr Duration kAges = Duration{4'000'000'000'000'000'000};
  if (yaml.has("first")) setup.first = GlobalTime{} + yaml.duration("first", {-kAges, kAges});
  if (setup.first && !setup.period) yaml.fail("first", "must not be given without period");
  setup.known = fusion::loading::load_known_sensor(yaml);
  yaml.finish();
  return setup;
}

}  // namespace

NamedSigma sigma_of(SensorNoise& noise, std::string_view name) {
  for (const SigmaName& sigma : kSigmas)
    if (name == sigma.name) return {&(noise.*sigma.member), sigma.allowed, sigma.unit};
  return {};
}

std::string sigma_names() {
  std::string names;
  for (const SigmaName& sigma : kSigmas) names += (names.empty() ? "" : ", ") + std::string(sigma.name);
  return names;
}

ReplayConfig read_replay_config(const StrictYaml& yaml, const SensorSetup& any, const OtherKeys& others) {
  expect_kind(yaml, FileKind::kTrack);
  Findings findings;
  YamlMap root = yaml.root(findings);
  ReplayConfig config;
  config.file = yaml.name();
  using fusion::strategies::kStrategyNames;
  config.strategy = root.choice_or<fusion::strategies::StrategyKind>("strategy", config.strategy,
                                                                     {kStrategyNames.begin(), kStrategyNames.end()});
  if (std::optional<YamlMap> tracker = root.map_if("tracker")) {
    config.tracker = fusion::loading::load_tracker(*tracker, fusion::loading::SensorsAre::kElsewhere);
    if (tracker->has("sensors"))
      tracker->fail("sensors",
                    "must not be given here: mounting, field and biases belong under the top-level key sensors");
    if (tracker->has("late")) config.late_line = tracker->line("late");
    tracker->finish();
  }
  if (root.has("sensors")) {
    for (auto& [sensor, map] : root.named_maps("sensors")) config.sensors.emplace_back(sensor, load_sensor(map, any));
    if (config.sensors.empty() || config.sensors.size() > kMostSensors)
      root.fail("sensors", fmt::format("must name 1..{} sensors", kMostSensors));
    for (const auto& sensor : config.sensors) config.tracker.sensors.push_back(sensor.second.known);
    fusion::loading::check_biases(config.tracker.sensors, root, "sensors");
  }
  if (std::optional<YamlMap> judgement = root.map_if("judgement")) {
    config.cut_off = fusion::loading::load_cut_off(*judgement);
    judgement->finish();
  }
  if (others) others(root);
  root.finish();
  findings.throw_if_any();
  return config;
}

ReplayConfig parse_replay_config(const std::string& text, const std::string& name, const SensorSetup& any) {
  return read_replay_config(StrictYaml::parse(text, name), any);
}

ReplayConfig load_replay_config(const std::string& path, const SensorSetup& any, const OtherKeys& others) {
  return read_replay_config(load_of_kind(path, FileKind::kTrack), any, others);
}

}  // namespace ttf::recording::replay
