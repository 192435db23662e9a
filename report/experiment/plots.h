// The plots of an experiment's report, with one curve per paradigm.
#pragma once

#include "report/experiment/folder.h"
#include "report/page/page.h"

namespace ttf::report::experiment {

// Plots over the numeric axis with most values. Each measure and each combination of the other axes' values has a view.
page::Plot means_plot(const ExperimentFolder& folder);
page::Plot differences_plot(const ExperimentFolder& folder);
// Plots distributions over the replications, with one view per measure and point.
page::Plot replications_plot(const ExperimentFolder& folder);

}  // namespace ttf::report::experiment
