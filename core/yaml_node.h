// Access to a parsed YAML text, for its readers and editors.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string_view>

namespace ttf {

// Returns an undefined node for an absent key.
inline YAML::Node child(const YAML::Node& node, std::string_view key) {
  if (node.IsDefined() && node.IsMap())
    for (const auto& entry : node)
      if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
  return YAML::Node(YAML::NodeType::Undefined);
}

// Returns the line, counted from 1; 0 for a node of no text.
inline int line_of(const YAML::Node& node) {
  return node.IsDefined() && node.Mark().line >= 0 ? node.Mark().line + 1 : 0;
}

}  // namespace ttf
