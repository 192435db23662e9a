// The page of one results folder, or of several side by side.
#pragma once

#include <string>
#include <vector>

#include "report/run/drive_sections.h"
#include "report/run/results_folder.h"

namespace ttf::report::run {

std::string run_report_html(std::vector<ResultsFolder> folders, const DiagramWindow& window);

}  // namespace ttf::report::run
