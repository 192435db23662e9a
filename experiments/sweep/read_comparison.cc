#include "experiments/sweep/read_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/counted.h"
#include "evaluation/measures/measure.h"

namespace ttf::experiments::sweep {
namespace {

using evaluation::measures::find_measure;
using evaluation::measures::Measure;

constexpr double kLargestHalfWidth = 1e12;

// Returns the axis of the grid that the key names; at least two of its values can be compared.
std::optional<std::size_t> axis_of(YamlMap& map, std::string_view key, const SweepFile& file) {
  const std::string name = map.text(key);
  const std::vector<const Axis*> grid = file.grid();
  std::vector<std::string> names;
  for (std::size_t a = 0; a < grid.size(); ++a) {
    if (grid[a]->settings.size() < 2) continue;
    if (grid[a]->name == name) return a;
    names.push_back(grid[a]->name);
  }
  if (map.has(key) && !name.empty())
    map.fail(key, names.empty() ? "must be an axis of the grid with two values or more, but there is none"
                                : "must be an axis of the grid with two values or more: " + joined(names));
  return std::nullopt;
}

// Returns the value of the axis that the key names; a finding for another one. `axis` may be null after a finding.
std::optional<std::size_t> setting_of(YamlMap& map, std::string_view key, const Axis* axis) {
  const std::string label = map.text(key);
  if (axis == nullptr) return std::nullopt;
  std::vector<std::string> labels;
  for (std::size_t s = 0; s < axis->settings.size(); ++s) {
    if (axis->settings[s].label == label) return s;
    labels.push_back(axis->settings[s].label);
  }
  if (map.has(key) && !label.empty())
    map.fail(key, fmt::format("must be one of the values of {}: {}", axis->name, joined(labels)));
  return std::nullopt;
}

void read_compare(YamlMap& map, SweepFile& file) {
  if (map.has("axis")) {
    const auto axis = axis_of(map, "axis", file);
    const auto baseline = setting_of(map, "baseline", axis ? file.grid()[*axis] : nullptr);
    if (axis) file.compared_axis = AxisComparison{*axis, baseline.value_or(0)};
  } else {
    file.baseline = paradigm_of(map, "baseline", file).value_or(0);
  }
  file.confidence = map.number_or("confidence", 0.95, {0.5, 0.9999});
  map.finish();
}

void read_interaction(YamlMap& map, SweepFile& file) {
  Interaction one;
  std::string measure = file.measures.empty() ? "" : file.measures.front();
  if (map.has("measure")) measure = measure_of(map, "measure", file);
  const auto place = std::find(file.measures.begin(), file.measures.end(), measure);
  const Measure* about = find_measure(measure);
  one.scale = about != nullptr && is_ratio_scale(*about) ? Scale::kRatio : Scale::kDifference;
  // Each difference of two shares has an interval for paired drives (experiments/results/share.h); a difference of two such
  // differences has none. Student's would have no width where the event never happens.
  if (about != nullptr && about->is_event)
    map.fail(map.has("measure") ? "measure" : "",
             fmt::format("must not be about {}, an event: an interaction of shares has no interval", measure));
  if (map.has("by"))
    one.scale = map.choice<Scale>("by", {{"ratio", Scale::kRatio}, {"difference", Scale::kDifference}});
  const auto axis = axis_of(map, "axis", file);
  const Axis* const values = axis ? file.grid()[*axis] : nullptr;
  auto before = std::optional<std::size_t>(0), after = before;
  if (values != nullptr) after = values->settings.size() - 1;
  if (map.has("from")) before = setting_of(map, "from", values);
  if (map.has("to")) after = setting_of(map, "to", values);
  if (values != nullptr && before && before == after)
    map.fail(map.has("to") ? "to" : "from",
             fmt::format("must not change {} from {} to itself", values->name, values->settings[*before].label));
  const auto first = paradigm_of(map, "lowers", file), second = paradigm_of(map, "more_than", file);
  if (first && first == second) map.fail("more_than", "must differ from `lowers`");
  map.finish();
  if (!axis || !before || !after || !first || !second || place == file.measures.end()) return;
  one.measure = static_cast<std::size_t>(place - file.measures.begin());
  one.axis = *axis;
  one.before = *before;
  one.after = *after;
  one.first = *first;
  one.second = *second;
  file.interactions.push_back(one);
}

}  // namespace

std::optional<std::size_t> paradigm_of(YamlMap& map, std::string_view key, const SweepFile& file) {
  const std::string name = map.text(key);
  std::vector<std::string> names;
  for (std::size_t p = 0; p < file.paradigms.size(); ++p) {
    if (file.paradigms[p].name == name) return p;
    names.push_back(file.paradigms[p].name);
  }
  if (map.has(key) && !name.empty()) map.fail(key, "must be one of the paradigms: " + joined(names));
  return std::nullopt;
}

std::string measure_of(YamlMap& map, std::string_view key, const SweepFile& file) {
  std::string name = map.text(key);
  if (std::find(file.measures.begin(), file.measures.end(), name) == file.measures.end())
    map.fail(key, "must be one of `measures`");
  return name;
}

void read_comparison(YamlMap& root, SweepFile& file) {
  if (auto compare = root.map_if("compare")) read_compare(*compare, file);
  for (YamlMap& map : root.maps_if("interactions")) read_interaction(map, file);
  auto stop = root.map_if("stop");
  if (!stop) return;
  file.stop = StopRule{stop->number("half_width", {0.0, kLargestHalfWidth}),
                       static_cast<std::uint32_t>(stop->integer("batch", {2, 1'000'000}))};
  if (file.paradigms.size() < 2) stop->fail("half_width", "needs two paradigms: it bounds their differences");
  if (file.compared_axis)
    stop->fail("half_width", "must be absent with `compare.axis`: a point alone has no difference from another one");
  stop->finish();
}

}  // namespace ttf::experiments::sweep
