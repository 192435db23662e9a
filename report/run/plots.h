// The plots of a run's report, a curve a drive.
#pragma once

#include <string>
#include <vector>

#include "report/drawing/names.h"
#include "report/page/page.h"
#include "report/run/tables.h"

namespace ttf::report::run {

page::Plot error_plot(const std::vector<ToldDrive>& drives);
page::Plot age_plot(const std::vector<ToldDrive>& drives);  // over time
page::Plot age_histogram(const std::vector<ToldDrive>& drives);
page::Plot precision_plot(const std::vector<ToldDrive>& drives);
page::Plot corrections_plot(const ToldDrive& drive, const drawing::Names& names);  // a curve a node

// Shares of the values in bins of one width over all of them, as curves of Plot::Kind::kSteps: x is where a bin begins,
// with one more of height 0 behind the last.
struct NamedValues {
  std::string label;
  int colour = 0;
  std::vector<double> values;
};
std::vector<page::Curve> histogram(const std::vector<NamedValues>& all, int bins);

}  // namespace ttf::report::run
