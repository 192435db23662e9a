// An experiment's tables as Markdown, for pages: every point that was driven is a row.
#pragma once

#include <string>

#include "report/experiment/folder.h"

namespace ttf::report::experiment {

// Returns a table for each measure: by point the baseline's mean, and the other paradigms' paired differences from it. Along
// an axis, each paradigm has both. Each interaction has a table. A difference that stays certain among all of its table, by
// Holm's method, is bold.
std::string markdown_tables(const ExperimentFolder& folder);

}  // namespace ttf::report::experiment
