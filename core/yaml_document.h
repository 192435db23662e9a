// Parses a YAML text that must be one document of printable characters.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace ttf {

// Throws InputError, in which `name` is the file.
YAML::Node parse_document(const std::string& text, const std::string& name);

}  // namespace ttf
