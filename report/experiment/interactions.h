// The interactions of an experiment as tables: a change's effect on one paradigm beside that on another.
#pragma once

#include "report/experiment/folder.h"
#include "report/page/page.h"

namespace ttf::report::experiment {

// Returns a row for each combination of the other axes' values. A star marks those that stay certain among all.
page::PageTable interaction_table(const ExperimentFolder& folder, const ExperimentInteraction& interaction);

}  // namespace ttf::report::experiment
