// The kinds of files: the program's YAML files, two formats of exchange, logs and captures. A file of another kind is one
// mistake. A loader that reads on would report each of its keys.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/strict_yaml.h"

namespace ttf {

enum class FileKind : std::uint8_t { kScenario, kCluster, kExperiment, kTrack, kFaults, kFibex, kDbc, kLog, kCapture };

// Returns the kind by its own keys at the top level: no other kind has them. Without such a key, the kind must have all keys.
// Returns none for other files.
std::optional<FileKind> kind_of(const StrictYaml& file);

// Does the same for any file. FIBEX is XML with FIBEX's namespace. DBC is a text with the sections BS_ and BU_. Logs (MCAP) and
// captures (pcap, pcapng) begin with bytes of their own. Throws the errors of StrictYaml::load() for other files.
std::optional<FileKind> kind_of_file(const std::string& path);

// Reads a YAML file. Throws InputError with one finding if it is of another kind, and the errors of StrictYaml::load().
StrictYaml load_of_kind(const std::string& path, FileKind wanted);

// Throws InputError with one finding if the file is of another kind. Files of no kind pass. So do those with an own key of the
// wanted kind: their loader has more.
void expect_kind(const StrictYaml& file, FileKind wanted);

// Throws InputError with one finding if the file is of another kind than a log, and is no log by its first bytes. Other files
// pass.
void expect_log(const std::string& path);

// Throws InputError with one finding if the file is of any other kind. Call it for a file that could not be read as `wanted`: "a
// recording", "a FIBEX file".
void refuse_any_kind(const std::string& path, std::string_view wanted);

}  // namespace ttf
