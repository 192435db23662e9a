// The content of a YamlMap: for its own sources.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <set>
#include <string>

#include "core/strict_yaml.h"

namespace ttf {

struct YamlMap::Content {
  std::string file;
  YAML::Node node;                // a map, or null for a missing one
  int line = 0;                   // for a missing one, the mapping's around it
  KeyAnswers* answers = nullptr;  // in place of the node
  std::set<std::string, std::less<>> asked, gone;
};

}  // namespace ttf
