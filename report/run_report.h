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

// `paths`: folders as the user named them, all of them runs. Throws InputError where one cannot be read.
std::string run_report_html(const std::vector<std::string>& paths, const RunReportOptions& options);

// The same of folders that were read: for tests.
std::string run_report_html(std::vector<RunFolder>& folders, const RunReportOptions& options);

}  // namespace ttf::report
