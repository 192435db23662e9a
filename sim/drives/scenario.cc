#include "sim/drives/scenario.h"

#include <filesystem>
#include <utility>

#include "core/file_kind.h"
#include "fusion/loading/tracker.h"
#include "sensors/kinds/loader.h"
#include "sim/drives/seeds.h"

namespace ttf::sim::drives {

Scenario::Scenario() = default;
Scenario::Scenario(const Scenario&) = default;
Scenario::Scenario(Scenario&&) noexcept = default;
Scenario& Scenario::operator=(const Scenario&) = default;
Scenario& Scenario::operator=(Scenario&&) noexcept = default;
Scenario::~Scenario() = default;

Scenario read_scenario(const StrictYaml& yaml) {
  expect_kind(yaml, FileKind::kScenario);
  const std::string& path = yaml.name();
  Findings findings;
  YamlMap root = yaml.root(findings);
  Scenario scenario;
  scenario.file = path;
  scenario.text = yaml.text();
  scenario.name = root.text("name");
  scenario.description = root.text("description");
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", kSeeds));
  constexpr Duration kLongest = Duration::milliseconds(3'600'000);
  const std::size_t mistakes = findings.size();
  scenario.duration = root.duration("duration", {Duration::milliseconds(100), kLongest});
  // Without a valid duration no other value is checked against it.
  const Duration latest = findings.size() == mistakes ? scenario.duration : kLongest;
  scenario.evaluate_from = root.duration_or("evaluate_from", Duration{}, {Duration{}, latest});

  scenario.startup = load_startup(root, latest);

  YamlMap clusters = root.map("clusters");
  for (const auto& [name, strategy] : fusion::strategies::kStrategyNames) {
    const std::string file = clusters.text(name);
    scenario.cluster_lines[static_cast<std::size_t>(strategy)] = clusters.line(name);
    scenario.cluster_files[static_cast<std::size_t>(strategy)] =
        (std::filesystem::path(path).parent_path() / file).lexically_normal().string();
  }
  clusters.finish();

  YamlMap world = root.map("world");
  scenario.world = sim::world::load_world(world);
  scenario.world.duration = scenario.duration;
  scenario.weather = sim::world::load_weather(world);
  world.finish();
  if (auto sensors = root.map_if("sensors")) {
    scenario.sensors = sensors::kinds::load_sensors(*sensors);
    sensors->finish();
  }
  apply_weather(scenario.weather, scenario.sensors);
  if (auto reference = root.map_if("reference")) {
    scenario.reference = sim::world::load_reference(*reference);
    reference->finish();
  }
  if (auto preprocessing = root.map_if("preprocessing")) {
    sensors::kinds::load_preprocessing(*preprocessing, scenario.sensors);
    preprocessing->finish();
  }
  if (auto tracker = root.map_if("tracker")) {
    scenario.tracker = fusion::loading::load_tracker(*tracker);
    tracker->finish();
  }
  if (auto recorded = root.map_if("recorded")) {
    scenario.recorded_noises = sensors::recorded::load_recorded_noises(*recorded);
    scenario.recorded_playing = sensors::recorded::load_recorded_playing(*recorded);
    recorded->finish();
  }
  const auto section_of = [&](std::string_view step) {
    auto section = root.map_if(step);
    if (section) scenario.step_sections.push_back({std::string(step), section->line()});
    return section;
  };
  if (auto feature = section_of("feature_service")) {
    scenario.feature = nodes::service::load_feature(*feature);
    feature->finish();
  }
  if (auto adaptive = section_of("adaptive_camera")) {
    scenario.adaptive_camera = nodes::vision::load_adaptive_camera(*adaptive);
    adaptive->finish();
  }
  if (auto cruise = section_of("adaptive_cruise_control")) {
    scenario.cruise = nodes::driving::load_cruise(*cruise);
    cruise->finish();
  }
  if (auto emergency = section_of("emergency_braking")) {
    scenario.emergency = nodes::driving::load_emergency(*emergency);
    emergency->finish();
  }
  if (auto lane = section_of("lane_keeping")) {
    scenario.lane_keeping = nodes::driving::steering::load_lane_keeping(*lane);
    lane->finish();
  }
  if (auto blind_spot = section_of("blind_spot_warning")) {
    scenario.blind_spot = nodes::driving::load_blind_spot(*blind_spot);
    blind_spot->finish();
  }
  if (auto planner = section_of("motion_planner")) {
    scenario.planner = nodes::driving::load_planner(*planner);
    planner->finish();
  }
  if (auto control = section_of("vehicle_control")) {
    scenario.control = nodes::driving::load_control(*control);
    control->finish();
  }
  if (auto judgement = root.map_if("judgement")) {
    scenario.cut_off = fusion::loading::load_cut_off(*judgement);
    scenario.reaction_speed_mps =
        judgement->number_or("reaction_speed", scenario.reaction_speed_mps, {0.1, 100.0}, "m/s");
    judgement->finish();
  }
  scenario.faults = ttf::faults::load_fault_plan(root, latest);
  root.finish();
  findings.throw_if_any();
  return scenario;
}

Scenario load_scenario(const std::string& path) { return read_scenario(load_of_kind(path, FileKind::kScenario)); }

Finding cluster_entry(const Scenario& scenario, fusion::strategies::StrategyKind strategy) {
  const auto index = static_cast<std::size_t>(strategy);
  return {scenario.file, scenario.cluster_lines[index], "clusters." + std::string(name_of(strategy)),
          scenario.cluster_files[index], ""};
}

Scenario parse_scenario(std::string text, std::string name) {
  return read_scenario(StrictYaml::parse(std::move(text), std::move(name)));
}

}  // namespace ttf::sim::drives
