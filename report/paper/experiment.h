// An experiment's results for a paper: for each measure a table and the script of its picture. The picture
// shows means over the first numeric axis with intervals, beside the paired differences from the baseline.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "report/paper/gnuplot.h"

namespace ttf::report::paper {

// A measure's unit (may be empty) and meaning.
struct MeasureWords {
  std::string unit, meaning;
};

// `summary` is an experiment's summary.csv, `file` is for messages. Throws InputError if it is no summary.
std::vector<PaperFile> paper_of_experiment(std::string_view summary, const std::string& file, const std::string& name,
                                           const std::function<MeasureWords(std::string_view measure)>& words);

}  // namespace ttf::report::paper
