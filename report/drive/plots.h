// The plots of a report, with one curve per drive.
#pragma once

#include <string>
#include <vector>

#include "report/drawing/names.h"
#include "report/drive/tables.h"
#include "report/page/page.h"

namespace ttf::report::drive {

page::Plot error_plot(const std::vector<ReportedDrive>& drives);
page::Plot age_plot(const std::vector<ReportedDrive>& drives);  // over time
page::Plot age_histogram(const std::vector<ReportedDrive>& drives);
page::Plot precision_plot(const std::vector<ReportedDrive>& drives);
page::Plot corrections_plot(const ReportedDrive& drive, const drawing::Names& names);  // one curve per node

// Returns the shares of the values in bins of one common width, as curves of Plot::Kind::kSteps. x is the
// begin of a bin; one more bin of height 0 follows the last.
struct NamedValues {
  std::string label;
  int colour = 0;
  std::vector<double> values;
};
std::vector<page::Curve> histogram(const std::vector<NamedValues>& all, int bins);

}  // namespace ttf::report::drive
