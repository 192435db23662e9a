// The plots of an experiment's report, a curve a paradigm.
#pragma once

#include "report/experiment/folder.h"
#include "report/page/page.h"

namespace ttf::report {

// Over the numeric axis with most values; a view a measure and combination of the other axes' values.
Plot means_plot(const ExperimentFolder& folder);
Plot differences_plot(const ExperimentFolder& folder);
// Distributions over the replications, a view a measure and point.
Plot replications_plot(const ExperimentFolder& folder);

}  // namespace ttf::report
