// Judges what preprocessing made of recorded laser scans: without any box there are reasons, with numbers.
#pragma once

#include <string>
#include <vector>

#include "sensors/laser/preprocessor.h"

namespace ttf::cli::logs {

// Returns one sentence for each cause that applies; empty if there is a box. `fates` may be those of several scans.
std::vector<std::string> reasons_for_no_box(const sensors::laser::LaserPreprocessingConfig& config,
                                            const sensors::laser::SegmentFates& fates);

}  // namespace ttf::cli::logs
