// The page of an experiment.
#pragma once

#include <string>
#include <vector>

#include "report/experiment_folder.h"

namespace ttf::report {

// `path`: the folder as the user named it. Throws InputError where it cannot be read.
std::string experiment_report_html(const std::string& path);

// Who has the least of the first measure, at how many points, and where for certain: against each of the others, paired
// by replication, by the runs in the store (without one nothing is certain).
std::string experiment_answer(const ExperimentFolder& folder);

}  // namespace ttf::report
