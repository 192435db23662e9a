// The plots of an experiment's report, a curve a paradigm.
#pragma once

#include "report/experiment/folder.h"
#include "report/page/page.h"

namespace ttf::report::experiment {

// Over the numeric axis with most values; a view a measure and combination of the other axes' values.
page::Plot means_plot(const ExperimentFolder& folder);
page::Plot differences_plot(const ExperimentFolder& folder);
// Distributions over the replications, a view a measure and point.
page::Plot replications_plot(const ExperimentFolder& folder);

}  // namespace ttf::report::experiment
