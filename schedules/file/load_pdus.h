// A PDU in a cluster file: {sensor, fragment_bytes, max_elements, elements_per_fragment, header: [...], element: [...]}.
#pragma once

#include "core/strict_yaml.h"
#include "schedules/file/names.h"
#include "schedules/model/pdu.h"

namespace ttf::schedules::file {

// Reads all but the name. A layout that does not fit a fragment, or cannot number its fragments, is a finding.
void load_pdu(YamlMap& map, const Names& names, model::PduLayout& layout);

}  // namespace ttf::schedules::file
