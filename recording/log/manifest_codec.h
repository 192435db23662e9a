// The manifest as an MCAP metadata record's list of (key, value), and back. Private to the module.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/log/manifest.h"

namespace ttf::recording::log {

inline constexpr std::string_view kLogProfile = "ttfusion";
inline constexpr std::string_view kManifestName = "ttfusion.manifest";
inline constexpr std::string_view kResultName = "ttfusion.result";  // written at the end: content hash, records

using ManifestEntries = std::vector<std::pair<std::string, std::string>>;

// Keys: version, seed, scenario, cluster, strategy, cycle_ns, bit_ps, task_lists, hash.<name>, node.<i>,
// node.<i>.task.<j>, pdu.<i>, pdu_sensor.<i>, sensor.<i>, can_bus.<i>; recording, clock, host,
// time_scale_ppm, cycles, sensor_kind.<i>, sensor_colour.<i> and sensor_marker.<i> unless they have their defaults; and crc32 over all of them.
ManifestEntries manifest_entries(const LogManifest& manifest);

// Reads every readable entry. Returns false if the checksum does not match (metadata has none of its own) or a
// number is broken.
bool read_manifest(const ManifestEntries& entries, LogManifest& manifest);

}  // namespace ttf::recording::log
