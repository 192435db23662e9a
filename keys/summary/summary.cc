#include "keys/summary/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "evaluation/measures/measure.h"
#include "keys/json/definitions.h"

namespace ttf::keys::summary {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::measures::Measure;

constexpr const char* kStrategy = "strategies[]";

// A member that is no measure; "?" before the type: not in every summary. Distributions and statistics have members of
// their own.
struct Row {
  const char* path;
  const char* type;
  const char* meaning;
};

constexpr Row kDrive[] = {
    {"scenario", "string", "name of the scenario"},
    {"seed", "integer", "seed of every random stream"},
    {"duration_s", "number", "length of the drive [s]"},
    {"truth", "?object", "trace in place of the scenario's objects"},
    {"truth.file", "string", "its name"},
    {"truth.length_s", "number", "its length [s]"},
    {"truth.objects", "?array", "its objects, in the order of our ids"},
    {"truth.objects[].id", "integer", "id in the trace"},
    {"truth.objects[].kind", "string", "class of the object"},
    {"strategies", "array", "drives, one for each strategy"},
};

constexpr Row kOfStrategy[] = {
    {"strategy", "string", "buff, adva or tt"},
    {"cluster", "string", "name of the cluster"},
};

constexpr Row kParts[] = {
    {"odometry", "?object", "odometry of the fusion node, if it has some"},
    {"driving", "?object", "drive in a closed loop, if commands drive the vehicle"},
    {"driving.collision", "object or null", "first collision"},
    {"driving.detections", "object or null", "detections, if cameras share a detector"},
    {"driving.lane", "?object", "place in the lane, if a service keeps one"},
    {"driving.lane_departure_warnings", "?object", "warnings of this service, if there is one"},
    {"driving.collision_warnings", "?object", "warnings of this service, if there is one"},
    {"driving.emergency_brakings", "?object", "brakings of this service, if there is one"},
    {"driving.blind_spot_warnings", "?object", "warnings of this service, if there is one; both sides together"},
};

constexpr Row kOthers[] = {
    {"age_when_used_by_sensor", "?object", "age when used, by sensor"},
    {"age_when_used_by_sensor.NAME.count", "integer", "uses of an image with a measurement of the sensor"},
    {"age_when_used_by_sensor.NAME.mean_ms", "number or null", "mean age [ms]"},
    {"age_when_used_by_sensor.NAME.worst_ms", "number or null", "largest age [ms]"},
    {"age_by_stage", "?object", "latency by stage, by sensor, beside the schedule's bounds"},
    {"age_by_stage.NAME.measured", "integer", "measurements of the sensor"},
    {"age_by_stage.NAME.seen", "integer", "measurements that went through all stages"},
    {"age_by_stage.NAME.to", "string", "last stage: use or fusion"},
    {"age_by_stage.NAME.stages", "?array", "stages, in their order"},
    {"age_by_stage.NAME.stages[].stage", "string", "name of the stage"},
    {"age_by_stage.NAME.stages[].bounds_ms", "array", "bounds of its length, best and worst [ms]"},
    {"age_by_stage.NAME.stages[].bounds_ms[]", "number or null", "a bound [ms]"},
    {"age_by_stage.NAME.stages[].had", "statistics", "its length"},
    {"age_by_stage.NAME.stages[].age_bounds_ms", "array", "bounds of the age at its end [ms]"},
    {"age_by_stage.NAME.stages[].age_bounds_ms[]", "number or null", "a bound [ms]"},
    {"age_by_stage.NAME.stages[].age", "statistics", "age at its end"},
    {"age_by_stage.NAME.stages[].beyond", "integer", "lengths or ages beyond their bounds"},
    {"startup", "?array", "nodes that started up or changed their state"},
    {"startup[].node", "string", "name of the node"},
    {"startup[].powered_on_ms", "number or null", "time of its supply [ms]"},
    {"startup[].active", "object or null", "first cycle in which it was active"},
    {"startup[].active.cycle", "integer", "number of the cycle"},
    {"startup[].active.at_ms", "number", "its time [ms]"},
    {"startup[].active.from", "string", "state before"},
    {"startup[].active.why", "string", "cause of the change"},
    {"startup[].state", "string", "state at the end; empty: not on FlexRay"},
    {"startup[].why", "string", "cause of this state"},
    {"can_load", "?object", "share of the time in which a private CAN carries bits, by its name"},
    {"can_load.NAME", "number", "load of the CAN"},
    {"content_hash", "string", "hash of the log's records; empty without a log"},
    {"log", "string", "path of the log; empty without one"},
    {"recording", "?object", "recording that the drive played"},
    {"recording.ends_after_s", "number", "time of its last row [s]"},
    {"recording.ends_early", "boolean", "it ends before the drive"},
    {"recording.made_track", "boolean", "a track came of it"},
    {"recording.reasons", "array", "reasons why the drive did not do its work"},
    {"recording.reasons[]", "string", "a sentence"},
    {"recording.sensors", "?array", "its sensors"},
    {"recording.sensors[].name", "string", "name of the sensor"},
    {"recording.sensors[].rows", "integer", "rows of the sensor"},
    {"recording.sensors[].lists", "integer", "lists of these rows"},
    {"recording.sensors[].unused_between_instants", "integer", "rows between two measurements of the schedule"},
    {"recording.sensors[].unused_beyond_the_end", "integer", "rows after the drive's end"},
    {"recording.sensors[].measurements_without_row", "integer", "measurements of the schedule without a row"},
};

constexpr Row kRealTimeAndFaults[] = {
    {"real_time", "?object", "lateness and loss of a drive in real time"},
    {"real_time.time_scale", "number", "time of the drive over real time"},
    {"real_time.nodes", "array", "nodes"},
    {"real_time.nodes[].node", "string", "name of the node"},
    {"real_time.nodes[].lateness_us", "object", "lateness, in real time"},
    {"real_time.nodes[].lateness_us.wake_ups", "lateness", "of wake-ups"},
    {"real_time.nodes[].lateness_us.floor", "lateness", "of the kernel's timer alone"},
    {"real_time.nodes[].lateness_us.departures", "lateness", "of frames that left"},
    {"real_time.nodes[].lateness_us.arrivals", "lateness", "of frames that came"},
    {"real_time.nodes[].lateness_us.transits", "lateness", "time of frames on their way"},
    {"real_time.nodes[].late_wake_ups", "integer", "late wake-ups"},
    {"real_time.nodes[].slots_missed", "integer", "frames that the node withheld, because they were late"},
    {"real_time.nodes[].late_frames", "integer", "frames of other nodes that came late"},
    {"real_time.nodes[].early_frames", "integer", "frames of other nodes that came early"},
    {"real_time.nodes[].frames_lost", "integer", "frames of other nodes that did not come: the next three together"},
    {"real_time.nodes[].withheld_by_the_sender", "integer", "frames that the sender withheld"},
    {"real_time.nodes[].sender_away", "integer", "frames of a sender that was not there"},
    {"real_time.nodes[].lost_on_the_way", "integer", "frames that were sent"},
    {"real_time.nodes[].medium", "object or null", "counts of the node's medium"},
    {"real_time.nodes[].medium.sent", "integer", "frames sent"},
    {"real_time.nodes[].medium.received", "integer", "frames received"},
    {"real_time.nodes[].medium.not_sent", "integer", "frames without room to send"},
    {"real_time.nodes[].medium.lost", "integer", "frames that the medium lost"},
    {"real_time.nodes[].medium.foreign", "integer", "frames of others"},
    {"real_time.nodes[].medium.malformed", "integer", "frames that are none"},
    {"real_time.nodes[].medium.dropped", "integer", "frames that were dropped before they were read"},
    {"real_time.nodes[].largest_offset_correction_us", "number or null", "largest correction of the clock [us]"},
    {"real_time.precision_us", "array", "distance of the clocks of a host"},
    {"real_time.precision_us[].host", "string", "name of the host"},
    {"real_time.precision_us[]", "distribution", "distance [us]"},
    {"real_time.sensor_to_feature_ms", "object", "age of measurements when an image is used, in real time"},
    {"real_time.sensor_to_feature_ms.newest", "distribution", "of the newest one [ms]"},
    {"real_time.sensor_to_feature_ms.oldest", "distribution", "of the sensors' oldest one [ms]"},
    {"real_time.reading_jitter_us", "?distribution", "jitter of the readings of commands [us]"},
    {"faults", "?array", "faults of the scenario that began"},
    {"faults[].fault", "integer", "its number in the scenario"},
    {"faults[].kind", "string", "its kind"},
    {"faults[].node", "string or null", "its node"},
    {"faults[].begins_s", "number", "its beginning [s]"},
    {"faults[].ends_s", "number or null", "its end [s]"},
    {"faults[].acts", "integer", "how often it acted"},
    {"faults[].first_act_s", "number or null", "time of the first act [s]"},
    {"faults[].first_act", "string", "the first act, in words"},
    {"faults[]", "effects", "its effects"},
    {"fault_free_nodes", "?array", "nodes on FlexRay without a fault until the end"},
    {"fault_free_nodes[]", "string", "name of a node"},
    {"unattributed", "?effects", "effects without a cause among the faults"},
    {"cans", "?array", "nodes with errors on a private CAN"},
    {"cans[].can", "string", "name of the CAN"},
    {"cans[].node", "string", "name of the node"},
    {"cans[].first_s", "number", "first error [s]"},
    {"cans[].error_passive", "integer", "times that the node became error passive"},
    {"cans[].bus_off", "integer", "times that it left the bus"},
    {"cans[].error_frames", "object", "error frames that it began, by the error"},
    {"cans[].error_frames.NAME", "integer", "their number"},
};

constexpr Row kOfLaunch[] = {
    {"not_in_operation_at_end", "?array", "of a launch: nodes that were not in operation at its end"},
    {"not_in_operation_at_end[].node", "string", "name of the node"},
    {"not_in_operation_at_end[].state", "string", "its state"},
    {"external_nodes", "?array", "of a launch: nodes in place of its own"},
    {"external_nodes[].node", "string", "name of the node"},
    {"external_nodes[].in_window", "integer", "frames in their window"},
    {"external_nodes[].early", "integer", "frames before it"},
    {"external_nodes[].late", "integer", "frames after it"},
    {"external_nodes[].malformed", "object", "malformed frames, by their kind"},
    {"external_nodes[].malformed.NAME", "integer", "their number"},
    {"external_nodes[].missing", "integer", "frames that did not come"},
    {"external_nodes[].never_heard", "boolean", "no frame came"},
    {"external_nodes[].first_after_s", "number or null", "time of the first frame [s]"},
    {"external_nodes[].state", "string", "state, in words"},
    {"verdict", "?object", "of a launch: whether lateness and loss matter"},
    {"verdict.matters", "boolean", "they matter"},
    {"verdict.sentence", "string", "the reason"},
};

// Types with members of their own.
constexpr Row kStatistics[] = {{"least_ms", "number", "least [ms]"},
                               {"mean_ms", "number", "mean [ms]"},
                               {"p99_ms", "number", "99th percentile [ms]"},
                               {"most_ms", "number", "most [ms]"}};
constexpr Row kDistribution[] = {{"count", "integer", "samples"},
                                 {"p50", "number or null", "median"},
                                 {"p99", "number or null", "99th percentile"},
                                 {"longest", "number or null", "longest"}};
constexpr Row kLateness[] = {{"count", "integer", "samples"},
                             {"p50", "number or null", "median [us]"},
                             {"p99", "number or null", "99th percentile [us]"},
                             {"p999", "number or null", "99.9th percentile [us]"},
                             {"longest", "number or null", "longest [us]"}};
constexpr Row kEffects[] = {
    {"checks", "array", "checks that failed"},
    {"checks[].check", "string", "name of the check"},
    {"checks[].by_faulty_node", "boolean", "a faulty node saw it"},
    {"checks[].cycles", "integer", "cycles in which it failed"},
    {"checks[].first_s", "number", "first time [s]"},
    {"checks[].nodes", "array", "nodes that saw it"},
    {"checks[].nodes[]", "string", "name of a node"},
    {"checks[].guardians", "?array", "channels whose guardian saw it"},
    {"checks[].guardians[]", "string", "A or B"},
    {"guardians", "array", "interventions of guardians"},
    {"guardians[].what", "string", "cut or blocked"},
    {"guardians[].why", "string", "cause"},
    {"guardians[].signals", "integer", "signals that were kept off"},
    {"guardians[].first_cycle", "integer", "first cycle"},
    {"guardians[].first_s", "number", "first time [s]"},
    {"states", "array", "changes of state"},
    {"states[].node", "string", "name of the node"},
    {"states[].from", "string", "state before"},
    {"states[].to", "string", "state after"},
    {"states[].why", "string", "cause"},
    {"states[].first_s", "number", "first time [s]"},
    {"states[].times", "integer", "how often"},
    {"harmed", "boolean", "a fault-free node was harmed"},
    {"harms", "array", "harms to fault-free nodes"},
    {"harms[].harm", "string", "its kind"},
    {"harms[].first_s", "number", "first time [s]"},
    {"harms[].node", "string or null", "harmed node"},
    {"harms[].sender", "string or null", "sender of the frame"},
    {"harms[].slot", "integer", "slot of the frame; 0: none"},
    {"harms[].times", "integer", "how often"},
};

struct Type {
  std::string_view name;
  std::span<const Row> members;
  const char* json;
};
constexpr Type kTypes[] = {{"statistics", kStatistics, "object or null"},
                           {"distribution", kDistribution, "object"},
                           {"lateness", kLateness, "object"},
                           {"effects", kEffects, "object"}};

std::string below(const std::string& place, std::string_view path) {
  return place.empty() ? std::string(path) : fmt::format("{}.{}", place, path);
}

void add(std::vector<Member>& members, const std::string& place, std::span<const Row> rows) {
  for (const Row& row : rows) {
    const bool optional = row.type[0] == '?';
    const std::string type = row.type + (optional ? 1 : 0), path = below(place, row.path);
    const auto* const found = std::ranges::find(kTypes, type, &Type::name);
    const bool plain = found == std::end(kTypes);
    members.push_back({path, plain ? type : found->json, row.meaning, optional});
    if (!plain) add(members, path, found->members);
  }
}

// "/nees/band_95/0" -> "nees.band_95[]"
std::string dotted(std::string_view pointer) {
  std::string path(pointer.substr(1));
  std::ranges::replace(path, '/', '.');
  const std::size_t last = path.rfind('.');
  if (last != std::string::npos && path.find_first_not_of("0123456789", last + 1) == std::string::npos)
    path = path.substr(0, last) + "[]";
  return path;
}

Member member_of(const Measure& measure) {
  Member member{below(kStrategy, dotted(measure.path)), measure.of.is_count() ? "integer or null" : "number or null",
                std::string(measure.meaning)};
  if (!measure.unit.empty()) member.meaning += fmt::format(" [{}]", measure.unit);
  return member;
}

// The steps of a path: "a[].b" has a, [] and b.
std::vector<std::string> steps_of(const std::string& path) {
  std::vector<std::string> steps;
  for (const char c : path)
    if (c == '[')
      steps.emplace_back("[");
    else if (c == '.')
      steps.emplace_back();
    else if (steps.empty())
      steps.emplace_back(1, c);
    else
      steps.back() += c;
  return steps;
}

// The part of a schema at a path. It is an object or a list, as its steps demand.
Json& part_at(Json& schema, const std::vector<std::string>& steps) {
  Json* part = &schema;
  for (const std::string& step : steps) {
    if (step == "[]")
      part = &(*part)["items"];
    else if (step == "NAME")
      part = &(*part)["additionalProperties"];
    else
      part = &(*part)["properties"][step];
  }
  return *part;
}

Json type_of(const std::string& type) {
  const std::size_t either = type.find(" or ");
  return either == std::string::npos ? Json(type) : Json{type.substr(0, either), type.substr(either + 4)};
}

// Completes objects: all other members are refused, and members are required unless they are optional.
void close(Json& schema, const std::string& path, const std::set<std::string>& optional) {
  if (schema.contains("items")) {
    schema["type"] = schema.value("type", Json("array"));
    close(schema["items"], path + "[]", optional);
  }
  const bool named = schema.contains("additionalProperties");
  if (named) close(schema["additionalProperties"], below(path, "NAME"), optional);
  if (!schema.contains("properties")) {
    if (named) schema["type"] = schema.value("type", Json("object"));
    return;
  }
  schema["type"] = schema.value("type", Json("object"));
  if (!named) schema["additionalProperties"] = false;
  for (auto& [key, value] : schema["properties"].items()) {
    close(value, below(path, key), optional);
    if (!optional.contains(below(path, key))) schema["required"].push_back(key);
  }
}

// Members that stand in one table. Those within a strategy have no "strategies[]." there.
struct Section {
  const char* heading;
  const char* file;
  bool within = false;
  std::vector<Member> members{};
};

std::vector<Section> sections() {
  std::vector<Section> all{{"The drive", "summary.md"},
                           {"Each strategy, within `strategies[]`", "summary.md", true},
                           {"Real time and faults, within `strategies[]`", "summary_faults.md", true},
                           {"A launch", "summary_faults.md"}};
  add(all[0].members, "", kDrive);
  std::vector<Member>& measured = all[1].members;
  add(measured, kStrategy, kOfStrategy);
  std::set<std::string> begun;
  for (const Measure& measure : evaluation::measures::measures()) {
    if (measure.path.empty()) continue;
    for (const Row& part : kParts)
      if (dotted(measure.path).starts_with(part.path) && begun.insert(part.path).second)
        add(measured, kStrategy, {&part, 1});
    Member member = member_of(measure);
    if (measured.back().path != member.path) measured.push_back(std::move(member));
  }
  add(measured, kStrategy, kOthers);
  add(all[2].members, kStrategy, kRealTimeAndFaults);
  add(all[3].members, "", kOfLaunch);
  return all;
}

std::string row_text(const Member& member, bool within) {
  const std::string name = within ? member.path.substr(std::string_view(kStrategy).size() + 1) : member.path;
  return fmt::format("| `{}` | {}{} | {} |\n", name, member.type, member.optional ? ", optional" : "", member.meaning);
}

constexpr const char* kBegin =
    "# summary.json: every member\n\n"
    "<!-- Written by `ttfusion keys summary --format markdown`. Meanings: evaluation/measures/table.cc. -->\n\n"
    "`ttfusion run` and `ttfusion launch` write `summary.json` into their folder, and print it with `--json`.\n"
    "`[]` stands for each entry of a list, `NAME` for any name. A value that a drive has not is null, and a part that "
    "it\n"
    "cannot have is absent. `keys/schemas/summary.schema.json` has the same for programs.\n";

}  // namespace

std::vector<Member> members() {
  std::vector<Member> all;
  for (const Section& section : sections()) all.insert(all.end(), section.members.begin(), section.members.end());
  return all;
}

std::string text() {
  std::string lines;
  for (const Member& member : members())
    lines +=
        fmt::format("{}: {}{}, {}\n", member.path, member.type, member.optional ? ", optional" : "", member.meaning);
  return lines;
}

std::vector<Page> pages() {
  std::vector<Page> all;
  for (const Section& section : sections()) {
    if (all.empty() || all.back().file != section.file) all.push_back({section.file, kBegin});
    std::string& text = all.back().text;
    text += fmt::format("\n## {}\n\n| member | type | meaning |\n|---|---|---|\n", section.heading);
    for (const Member& member : section.members) text += row_text(member, section.within);
  }
  return all;
}

Page schema() {
  Json whole{{"$schema", "http://json-schema.org/draft-07/schema#"},
             {"title", "summary.json"},
             {"description", "The results of a drive, as `ttfusion run` and `ttfusion launch` write them."}};
  std::set<std::string> optional;
  for (const Member& member : members()) {
    Json& part = part_at(whole, steps_of(member.path));
    part["type"] = type_of(member.type);
    if (!part.contains("description")) part["description"] = member.meaning;
    if (member.type.starts_with("integer")) part["minimum"] = 0;
    if (member.optional) optional.insert(member.path);
  }
  close(whole, "", optional);
  return {fmt::format("{}.schema.json", kKind), json::text_of(json::with_definitions(std::move(whole))) + "\n"};
}

}  // namespace ttf::keys::summary
