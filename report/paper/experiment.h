// An experiment's numbers for a paper: of each measure a table and the script of its picture, means over the first
// numeric axis with their intervals beside the paired differences from the baseline.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "report/paper/gnuplot.h"

namespace ttf::report::paper {

// What is known of a measure: its unit (empty: none) and what it means.
struct MeasureWords {
  std::string unit, meaning;
};

// `summary`: an experiment's summary.csv, `file` for messages. Throws InputError where it is none.
std::vector<PaperFile> paper_of_experiment(std::string_view summary, const std::string& file, const std::string& name,
                                           const std::function<MeasureWords(std::string_view measure)>& words);

}  // namespace ttf::report::paper
