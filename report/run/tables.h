// A run's measures, from summary.json: tables of them, and what they come to in sentences.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/page/page.h"
#include "report/run/results_folder.h"
#include "report/run/series.h"

namespace ttf::report::run {

struct ToldDrive {
  const Drive* drive = nullptr;
  RunSeries series;  // empty without a log
};

// The number at the pointer ("/rmse_truth/position_m") of a drive's summary.
std::optional<double> measure_at(const Drive& drive, const char* pointer);
// Of the log, over the whole drive, where there is no summary.
double position_rmse(const ToldDrive& told);

// A column a drive; rows that say nothing in any of them are left out.
page::PageTable measure_table(const std::vector<ToldDrive>& drives);
// Several runs of one scenario with other seeds: by strategy the mean of each measure with its 95 % interval, and the
// paired difference from the first strategy's. Nothing where no two runs have the same strategies.
std::vector<page::PageTable> repeated_tables(const std::vector<ToldDrive>& drives);

// What came out: first the answer, then what else is worth knowing.
struct RunAnswer {
  std::string answer;
  std::vector<std::string> more;
};
RunAnswer run_answer(const std::vector<ToldDrive>& drives);

// Faults, what receivers saw, deadlines: tables with a row at least.
std::vector<page::PageTable> trouble_tables(const ToldDrive& told);

}  // namespace ttf::report::run
