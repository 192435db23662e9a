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

using evaluation::measures::Measure;

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
  Member member{dotted(measure.path), measure.of.is_count() ? "integer or null" : "number or null",
                std::string(measure.meaning)};
  if (!measure.unit.empty()) member.meaning += fmt::format(" [{}]", measure.unit);
  return member;
}

// The place of a path's part in a schema: "a[].NAME" is at /properties/a/items/additionalProperties.
Json::json_pointer place_of(std::string_view path) {
  std::string place;
  while (!path.empty()) {
    const bool entry = path.starts_with("[]");
    const std::string_view step = path.substr(0, entry ? 2 : std::min(path.find_first_of("[."), path.size()));
    path.remove_prefix(step.size());
    if (path.starts_with('.')) path.remove_prefix(1);
    place += entry ? "/items" : step == "NAME" ? "/additionalProperties" : fmt::format("/properties/{}", step);
  }
  return Json::json_pointer(place);
}

Json schema_type(const std::string& type) {
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

// Members that stand in one table of a page, from the first one on. Those within a strategy have no "strategies[]." there.
struct Section {
  const char* heading;
  const char* file;
  std::string_view first;
  std::string_view within = "";
};
constexpr std::string_view kStrategy = "strategies[].";
constexpr Section kSections[] = {
    {"The drive", "summary.md", "scenario"},
    {"Each strategy, within `strategies[]`", "summary.md", "strategies[].strategy", kStrategy},
    {"Real time and faults, within `strategies[]`", "summary_faults.md", "strategies[].real_time", kStrategy},
    {"A launch", "summary_faults.md", "not_in_operation_at_end"},
};

std::string optional_type(const Member& member) { return member.type + (member.optional ? ", optional" : ""); }

constexpr const char* kBegin =
    "# summary.json: every member\n\n"
    "<!-- Written by `ttfusion keys summary --format markdown`. Meanings: evaluation/measures/table.cc. -->\n\n"
    "`ttfusion run` and `ttfusion launch` write `summary.json` into their folder, and print it with `--json`.\n"
    "`[]` stands for each entry of a list, `NAME` for any name. A value that a drive does not have is null, and a part "
    "that "
    "it\n"
    "cannot have is absent. `keys/schemas/summary.schema.json` has the same for programs.\n";

}  // namespace

std::vector<Member> measured() {
  const Member parts[] = {
      {"odometry", "object", "odometry of the fusion node, if it has some", true},
      {"driving", "object", "drive in a closed loop, if commands drive the vehicle", true},
      {"driving.collision", "object or null", "first collision"},
      {"driving.detections", "object or null", "detections, if cameras share a detector"},
      {"driving.lane", "object", "place in the lane, if a service keeps one", true},
      {"driving.lane_departure_warnings", "object", "warnings of this service, if there is one", true},
      {"driving.collision_warnings", "object", "warnings of this service, if there is one", true},
      {"driving.emergency_brakings", "object", "brakings of this service, if there is one", true},
      {"driving.blind_spot_warnings", "object", "warnings of this service, if there is one; both sides together", true},
  };
  std::vector<Member> all;
  std::set<std::string> begun;
  for (const Measure& measure : evaluation::measures::measures()) {
    if (measure.path.empty()) continue;
    Member member = member_of(measure);
    for (const Member& part : parts)
      if (member.path.starts_with(part.path + ".") && begun.insert(part.path).second) all.push_back(part);
    if (all.empty() || all.back().path != member.path) all.push_back(std::move(member));
  }
  return all;
}

std::string text(const std::vector<Member>& members) {
  std::string lines;
  for (const Member& member : members)
    lines += fmt::format("{}: {}, {}\n", member.path, optional_type(member), member.meaning);
  return lines;
}

std::vector<Page> pages(const std::vector<Member>& members) {
  std::vector<Page> all;
  const Section* section = nullptr;
  for (const Member& member : members) {
    if (const auto* const begun = std::ranges::find(kSections, member.path, &Section::first);
        begun != std::end(kSections)) {
      section = begun;
      if (all.empty() || all.back().file != section->file) all.push_back({section->file, kBegin});
      all.back().text += fmt::format("\n## {}\n\n| member | type | meaning |\n|---|---|---|\n", section->heading);
    }
    all.back().text += fmt::format("| `{}` | {} | {} |\n", member.path.substr(section->within.size()),
                                   optional_type(member), member.meaning);
  }
  return all;
}

Page schema(const std::vector<Member>& members) {
  Json whole{{"$schema", "http://json-schema.org/draft-07/schema#"},
             {"title", "summary.json"},
             {"description", "The results of a drive, as `ttfusion run` and `ttfusion launch` write them."}};
  std::set<std::string> optional;
  for (const Member& member : members) {
    Json& part = whole[place_of(member.path)];
    part["type"] = schema_type(member.type);
    if (!part.contains("description")) part["description"] = member.meaning;
    if (member.type.starts_with("integer")) part["minimum"] = 0;
    if (member.optional) optional.insert(member.path);
  }
  close(whole, "", optional);
  return {fmt::format("{}.schema.json", kKind), json::text_of(json::with_definitions(std::move(whole))) + "\n"};
}

}  // namespace ttf::keys::summary
