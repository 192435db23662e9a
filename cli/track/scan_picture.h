// Draws a recorded scan and the tracks that are known once it was taken in.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/time.h"
#include "fusion/tracks/view.h"
#include "recording/rows/scan_file.h"
#include "report/plots/boxes_picture.h"
#include "sensors/laser/recorded_scans.h"

namespace ttf::cli::track {

class ScanPicture {
 public:
  ScanPicture(const recording::rows::RecordedScan& scan, const sensors::laser::RecordedScansConfig& how);
  // Takes the tracks whose state is of the scan's instant; the last ones count.
  void take(std::span<const fusion::tracks::TrackView> tracks);
  std::string svg(const report::drawing::Sheet& sheet) const;

 private:
  const recording::rows::RecordedScan& scan_;
  GlobalTime at_;
  std::vector<report::plots::Box> boxes_;
};

}  // namespace ttf::cli::track
