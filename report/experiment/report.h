// The page of an experiment.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/experiment/folder.h"
#include "report/run/drive_sections.h"
#include "report/run/results_folder.h"

namespace ttf::report::experiment {

// One run of every paradigm, driven again for its log.
struct ExperimentDrives {
  std::uint32_t point = 0, replication = 0;
  std::vector<run::Drive> drives;  // with logs, in the order of the folder's paradigms; or none
  std::string why_none;            // a sentence; empty where they were not asked for
};

std::string experiment_report_html(const ExperimentFolder& folder, const ExperimentDrives& drives,
                                   const run::DiagramWindow& window);

// Who has the least of the first measure, at how many points, and where for certain: against each of the others, paired
// by replication, by the runs in the store (without one nothing is certain).
std::string experiment_answer(const ExperimentFolder& folder);

}  // namespace ttf::report::experiment
