// Judges what preprocessing made of a recorded laser scan: a scan without any box has its reasons, with numbers.
#pragma once

#include <string>
#include <vector>

#include "nodes/laser/laser_preprocessor.h"
#include "recording/rows/laser_radar_file.h"

namespace ttf::cli::logs {

// Returns one sentence for each cause that applies; empty if there is a box.
std::vector<std::string> reasons_for_no_box(const recording::rows::RecordedScan& scan,
                                            const nodes::laser::LaserPreprocessingConfig& config,
                                            const nodes::laser::SegmentFates& fates);

}  // namespace ttf::cli::logs
