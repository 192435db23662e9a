#include "schedules/file/vary.h"

#include <algorithm>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "core/yaml_edit.h"

namespace ttf::schedules::file {
namespace {

// Returns whether the path's entry is like another one, and lacks the key.
bool inherits(const ClusterText& text, std::string_view path) {
  const std::size_t first = path.find('.'), last = path.rfind('.');
  const std::string_view section = path.substr(0, first);
  if (first == last || (section != "sensors" && section != "pdus")) return false;
  Findings none;
  const StrictYaml file = StrictYaml::parse(text.text, text.name);
  YamlMap root = file.root(none);
  auto entries = root.map_if(section);
  const auto entry = entries ? entries->map_if(path.substr(first + 1, last - first - 1)) : std::nullopt;
  return entry && entry->has("like") && entry->lacks(path.substr(last + 1));
}

}  // namespace

bool leaves_out(const ClusterText& text, std::string_view path) {
  const std::size_t last = path.rfind('.');
  if (last == std::string_view::npos) return false;
  const bool of_node = path.starts_with("nodes.") && path.substr(0, last).ends_with(".flexray");
  const std::string shared = "node_parameters." + std::string(path.substr(last + 1));
  try {
    const model::Cluster cluster = parse_cluster(text);
    return inherits(text, path) ||
           std::any_of(cluster.derived.begin(), cluster.derived.end(), [&](const model::DerivedValue& one) {
             return one.path == path || (of_node && one.path == shared);
           });
  } catch (const InputError&) {
    return false;
  }
}

ClusterText with_key(ClusterText text, std::string_view path, std::string_view value) {
  int line = 0;
  text.text = ttf::with_key(text.text, text.name, path, value, &line);
  if (line > 0) text.origins.insert(line);
  return text;
}

}  // namespace ttf::schedules::file
