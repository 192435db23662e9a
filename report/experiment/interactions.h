// The interactions of an experiment as tables: a change's effect on one paradigm beside that on another.
#pragma once

#include <cstdint>

#include "report/experiment/folder.h"
#include "report/page/page.h"

namespace ttf::report::experiment {

// How figures that stay certain are marked.
enum class Marks : std::uint8_t { kStar, kBold };

// Returns a row for each combination of the other axes' values. Those that stay certain among all interactions are marked.
page::PageTable interaction_table(const ExperimentFolder& folder, const ExperimentInteraction& interaction,
                                  Marks marks = Marks::kStar);

}  // namespace ttf::report::experiment
