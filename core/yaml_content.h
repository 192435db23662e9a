// The content of a YamlMap: for its own sources.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "core/strict_yaml.h"
#include "core/yaml_node.h"

namespace ttf {

struct YamlMap::Content {
  std::string file;
  YAML::Node node;                           // a map, or null for a missing one
  int line = 0;                              // for a missing one, the mapping's around it
  KeyAnswers* answers = nullptr;             // in place of the node
  std::shared_ptr<const Content> inherited;  // has the keys that the node lacks
  std::set<std::string, std::less<>> asked, gone;
  Findings muted;  // findings that are ignored

  YAML::Node child(std::string_view key) const {
    const YAML::Node own = ttf::child(node, key);
    return own.IsDefined() || !inherited ? own : inherited->child(key);
  }
};

}  // namespace ttf
