// The measures of drives, from summary.json: in tables, and summed up in sentences.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/drive/results_folder.h"
#include "report/drive/series.h"
#include "report/page/page.h"
#include "report/scene/scene.h"

namespace ttf::report::drive {

struct ReportedDrive {
  const Drive* drive = nullptr;
  DriveSeries series;    // empty without a log
  scene::Scene scene{};  // empty without one, and beyond the first kMostScenes
};

// Returns the number at the pointer ("/rmse_truth/position_m") of a drive's summary.
std::optional<double> value_at(const Drive& drive, std::string_view pointer);
// Returns the position error [m] from the summary or, without one, from the log over the whole drive.
double position_rmse(const ReportedDrive& reported);

// Returns one column per drive; rows without a value in any drive are omitted.
page::PageTable measure_table(const std::vector<ReportedDrive>& drives);
// Compares drives of one scenario with several seeds. The tables have each strategy's mean of each measure
// with its 95 % interval, and its paired difference from the first strategy. Empty if fewer than two seeds
// have all strategies.
std::vector<page::PageTable> repeated_tables(const std::vector<ReportedDrive>& drives);

// The conclusion: first the answer, then further remarks.
struct DrivesAnswer {
  std::string answer;
  std::vector<std::string> more;
};
DrivesAnswer answer_of(const std::vector<ReportedDrive>& drives);

// Returns tables of faults, slot problems and deadlines, each with at least one row.
std::vector<page::PageTable> trouble_tables(const ReportedDrive& reported);

}  // namespace ttf::report::drive
