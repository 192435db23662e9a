// The kinds of YAML files that the program reads. A file of another kind is one mistake. A loader that reads on would report
// each of its keys.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/strict_yaml.h"

namespace ttf {

enum class FileKind : std::uint8_t { kScenario, kCluster, kExperiment, kTrack, kFaults };

// Returns the kind by its own keys at the top level: no other kind has them. Without such a key, the kind must know all keys.
// Returns none for other files.
std::optional<FileKind> kind_of(const StrictYaml& file);

// Throws InputError with one finding if the file is of another kind. Files of no kind pass. So do those with an own key of the
// wanted kind: their loader knows more.
void expect_kind(const StrictYaml& file, FileKind wanted);

// Throws InputError with one finding if the file is of any kind. Call it for a file that is no recording or the like; `wanted`
// names it: "a recording".
void refuse_any_kind(const std::string& path, std::string_view wanted);

}  // namespace ttf
