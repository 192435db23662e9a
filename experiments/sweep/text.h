// An experiment's answer in words and tables, and its numbers as CSV for spreadsheets and papers.
#pragma once

#include <string>

#include "experiments/sweep/answer.h"

namespace ttf::experiments::sweep {

// Returns the question, the first measure by point, and the answer in sentences.
std::string answer_text(const SweepFile& sweep, const SweepAnswer& answer);
// For each paradigm but the baseline: at how many points its first measure is less, more or undecided, and
// where that changes for certain. Then how many of these comparisons stay certain together.
std::string answer_sentences(const SweepFile& sweep, const SweepAnswer& answer);

// point, the axes' values, paradigm, measure, count, mean, half_width, difference, difference_half_width
std::string summary_csv(const SweepFile& sweep, const SweepAnswer& answer);
// point, the axes' values, replication, paradigm, status, the store's columns
std::string runs_csv(const SweepFile& sweep, const results::Store& store);

}  // namespace ttf::experiments::sweep
