// Recorded scans as lists of one sensor: each goes through the laser's preprocessing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "recording/replay/config.h"
#include "recording/replay/recorded_lists.h"
#include "recording/rows/scan_file.h"
#include "sensors/laser/recorded_scans.h"

namespace ttf::cli::track {

// Counts over all scans.
struct ScanAccount {
  std::uint64_t scans = 0, returns = 0;
  sensors::laser::SegmentFates fates;
  std::uint64_t left_out = 0;  // boxes beyond max_observations of the tracker: the farthest of their scans
};

struct ScanLists {
  recording::replay::RecordedLists recorded;
  ScanAccount account;
};

// Returns the lists of the configuration's only sensor, one a scan. Frame n is at n periods, unless scans have a time.
// `name` is the file's. Throws InputError if a frame is too late.
ScanLists lists_of(const std::vector<recording::rows::RecordedScan>& scans,
                   const sensors::laser::RecordedScansConfig& how, const recording::replay::ReplayConfig& config,
                   const std::string& name);

}  // namespace ttf::cli::track
