// A PDU in a cluster file: {sensor, fragment_bytes, max_elements, elements_per_fragment, header: [...], element: [...]}. With
// `like: OTHER` it has the other's value for each key that it lacks.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/strict_yaml.h"
#include "schedules/file/names.h"
#include "schedules/model/pdu.h"

namespace ttf::schedules::file {

using NamedMaps = std::vector<std::pair<std::string, YamlMap>>;

// Reads all of pdus[own] but the name. A layout that does not fit a fragment, or cannot number its fragments, is a finding.
void load_pdu(NamedMaps& pdus, std::size_t own, const Names& names, model::PduLayout& layout);

}  // namespace ttf::schedules::file
