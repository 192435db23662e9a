// The page of an experiment.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/drive/drive_sections.h"
#include "report/drive/results_folder.h"
#include "report/experiment/folder.h"

namespace ttf::report::experiment {

// One drive of each paradigm, driven again for its log.
struct ExperimentDrives {
  std::uint32_t point = 0, replication = 0;
  std::vector<drive::Drive> drives;  // with logs, in the order of the folder's paradigms; or empty
  std::string why_none;              // a sentence; empty if no drives were requested
};

std::string experiment_report_html(const ExperimentFolder& folder, const ExperimentDrives& drives,
                                   const drive::DiagramWindow& window);

}  // namespace ttf::report::experiment
