// `like: OTHER` in a sensor or a PDU of a cluster file: the entry has the other's value for each key that it lacks.
//
// The other one may stand behind it, or be like a third one. A key that the entry does not read, as `offset` of a sensor that
// measures freely, is not taken.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf::schedules::file::likeness {

using NamedMaps = std::vector<std::pair<std::string, YamlMap>>;

// Lets entries with `like` inherit from others. Returns the other's number, by entry. A name of no other entry is a finding, and
// so is a circle.
std::vector<std::optional<std::size_t>> inherit_alike(NamedMaps& entries, std::string_view what);

}  // namespace ttf::schedules::file::likeness
