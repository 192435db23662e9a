// The keys of an experiment's file that compare: `compare`, `interactions` and `stop`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/strict_yaml.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

// Reads the three keys into `file`, whose paradigms, axes and measures are there already. Mistakes are findings of `root`.
void read_comparison(YamlMap& root, SweepFile& file);

// Returns the paradigm that the key names; a finding, and no value, for another name.
std::optional<std::size_t> paradigm_of(YamlMap& map, std::string_view key, const SweepFile& file);
// Returns the measure that the key names, as text; a finding if it is not one of `measures`.
std::string measure_of(YamlMap& map, std::string_view key, const SweepFile& file);

}  // namespace ttf::experiments::sweep
