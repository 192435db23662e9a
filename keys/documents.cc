#include "keys/documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "experiments/campaign/file.h"
#include "experiments/sweep/file.h"
#include "faults/plan.h"
#include "recording/replay/config.h"
#include "schedules/file/loader.h"
#include "schedules/synthesis/plan/loader.h"
#include "sensors/laser/recorded_scans.h"
#include "sim/drives/scenario.h"

namespace ttf::keys {
namespace {

constexpr Duration kLongestDrive = Duration::milliseconds(3'600'000);

// The two kinds of experiments have one key in common, which says the kind.
void load_experiment(const StrictYaml& yaml) {
  Findings findings;
  YamlMap root = yaml.root(findings);
  if (root.choice<bool>("kind", {{"sweep", true}, {"fault_campaign", false}}))
    experiments::sweep::read_sweep(yaml);
  else
    experiments::campaign::read_campaign(yaml);
}

// Recorded scans are the command's, not the replay's.
void read_scans(YamlMap& root) {
  if (std::optional<YamlMap> scans = root.map_if("scans")) {
    sensors::laser::load_recorded_scans(*scans);
    scans->finish();
  }
}

std::vector<Chapter> scenario_chapters() {
  std::vector<Chapter> chapters{{"", scenario_descriptions()},
                                {"world.ego", ego_descriptions()},
                                {"world.road", road_descriptions()},
                                {"world.traffic_lights[]", traffic_light_descriptions()},
                                {"tracker", tracker_descriptions()},
                                {"tracker.sensors.NAME", known_sensor_descriptions()},
                                {"tracker.sensors.NAME.mounting", mounting_descriptions()},
                                {"faults[]", fault_descriptions()}};
  for (const char* place : {"world.size", "world.objects[].size"}) chapters.push_back({place, size_descriptions()});
  for (const KindDescriptions& kind : kind_descriptions())
    chapters.push_back({fmt::format("preprocessing.{}", kind.word), kind.preprocessing});
  // A kind's own entry, or that of any name.
  const auto add_sensor = [&](std::string_view name) {
    const std::string place = fmt::format("sensors.{}", name);
    chapters.push_back({place, sensor_descriptions()});
    chapters.push_back({place + ".mounting", mounting_descriptions()});
    for (const KindDescriptions& kind : kind_descriptions()) {
      const bool any = name == kAnyName;
      if (!any && name != kind.word) continue;
      const std::string when = any ? fmt::format("kind={}", kind.word) : "";
      chapters.push_back({place, kind.sensor, when});
      chapters.push_back({place + ".preprocessing", kind.preprocessing, when});
    }
  };
  for (const KindDescriptions& kind : kind_descriptions()) add_sensor(kind.word);
  add_sensor(kAnyName);
  // Keys within a mapping that one kind alone has need no condition.
  const auto add_within = [&](std::string place, Descriptions rows) {
    if (std::ranges::any_of(rows, [](const Description& row) { return row.key.find('.') != row.key.npos; }))
      chapters.push_back({std::move(place), rows});
  };
  for (const KindDescriptions& kind : kind_descriptions()) {
    add_within(fmt::format("sensors.{}", kAnyName), kind.sensor);
    add_within(fmt::format("sensors.{}.preprocessing", kAnyName), kind.preprocessing);
  }
  return chapters;
}

std::vector<Document> all() {
  return {
      {"scenario", "Scenario",
       "A scenario says what happens in a drive: world, sensors, tracker, faults, and the cluster of each strategy.",
       [](const StrictYaml& yaml) { sim::drives::read_scenario(yaml); }, scenario_chapters()},
      {"cluster",
       "Cluster",
       "A cluster file says what happens in a cluster, and when: nodes, tasks, sensors, lists, FlexRay and CAN.",
       [](const StrictYaml& yaml) { schedules::file::read_cluster(yaml); },
       {{"", cluster_descriptions()},
        {"flexray", cluster_parameter_descriptions()},
        {"node_parameters", node_parameter_descriptions()},
        {"nodes.NAME.flexray", node_parameter_descriptions()}}},
      {"plan",
       "Plan",
       "A plan is a cluster file with values left out, and a section `plan` with demands on them "
       "(docs/schedules/synthesis.md).",
       schedules::synthesis::plan::ask_for_keys,
       {{"", plan_descriptions()},
        {"", cluster_descriptions()},
        {"flexray", cluster_parameter_descriptions()},
        {"node_parameters", node_parameter_descriptions()},
        {"nodes.NAME.flexray", node_parameter_descriptions()}}},
      {"experiment",
       "Experiment",
       "An experiment is a sweep, which drives paradigms over a grid, or a campaign, which injects single faults.",
       load_experiment,
       {{"", experiment_descriptions()}}},
      {"track",
       "Track configuration",
       "A track configuration says with which strategy, tracker and sensors `ttfusion track` replays observations.",
       [](const StrictYaml& yaml) { recording::replay::read_replay_config(yaml, {}, read_scans); },
       {{"", track_descriptions()},
        {"scans.preprocessing", laser_preprocessing_descriptions()},
        {"tracker", tracker_descriptions()},
        {"sensors.NAME", known_sensor_descriptions()},
        {"sensors.NAME.mounting", mounting_descriptions()}}},
      {"faults",
       "Fault list",
       "A fault list says what goes wrong in the drives of an experiment whose scenario has no faults of its own.",
       [](const StrictYaml& yaml) { faults::read_fault_plan(yaml, kLongestDrive); },
       {{"", fault_list_descriptions()}, {"faults[]", fault_descriptions()}}},
  };
}

// "kind=noise" holds where the conditions have this value of the key.
bool holds(std::string_view when, const std::vector<Condition>& conditions) {
  if (when.empty()) return true;
  const std::size_t sign = when.find('=');
  return std::any_of(conditions.begin(), conditions.end(), [&](const Condition& condition) {
    return condition.key == when.substr(0, sign) &&
           std::find(condition.values.begin(), condition.values.end(), when.substr(sign + 1)) != condition.values.end();
  });
}

}  // namespace

const Description* Document::describe(const std::string& path, const std::vector<Condition>& conditions) const {
  for (const Chapter& chapter : chapters) {
    const std::string start = chapter.place.empty() ? "" : chapter.place + ".";
    if (!path.starts_with(start) || !holds(chapter.when, conditions)) continue;
    for (const Description& row : chapter.rows)
      if (row.key == std::string_view(path).substr(start.size()) && holds(row.when, conditions)) return &row;
  }
  return nullptr;
}

const std::vector<Document>& documents() {
  static const std::vector<Document> kDocuments = all();
  return kDocuments;
}

}  // namespace ttf::keys
