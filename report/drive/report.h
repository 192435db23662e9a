// The page of one results folder, or of several side by side.
#pragma once

#include <string>
#include <vector>

#include "report/drive/drive_sections.h"
#include "report/drive/results_folder.h"

namespace ttf::report::drive {

std::string drive_report_html(std::vector<ResultsFolder> folders, const DiagramWindow& window);

}  // namespace ttf::report::drive
