#include "schedules/file/vary.h"

#include <algorithm>

#include "core/errors.h"
#include "core/yaml_edit.h"

namespace ttf::schedules::file {

bool leaves_out(const ClusterText& text, std::string_view path) {
  const std::size_t last = path.rfind('.');
  if (last == std::string_view::npos) return false;
  const bool of_node = path.starts_with("nodes.") && path.substr(0, last).ends_with(".flexray");
  const std::string shared = "node_parameters." + std::string(path.substr(last + 1));
  try {
    const model::Cluster cluster = parse_cluster(text);
    return std::any_of(cluster.derived.begin(), cluster.derived.end(), [&](const model::DerivedValue& one) {
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
