// The page of one run, or of several side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "report/run_folder.h"

namespace ttf::report {

struct RunReportOptions {
  // Of the timing diagrams; 160 ms from where the drive is judged unless given.
  std::optional<TrueTime> from, to;
};

std::string run_report_html(std::vector<RunFolder> folders, const RunReportOptions& options);

}  // namespace ttf::report
