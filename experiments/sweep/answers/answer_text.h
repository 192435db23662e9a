// An experiment's answer in words and tables, and its numbers as CSV for spreadsheets and papers.
#pragma once

#include <string>

#include "experiments/sweep/answers/answer.h"

namespace ttf::experiments::sweep::answers {

// Returns the question, the answer in sentences, and tables by point: the first measure with its differences, and the
// interactions. Tables are at most 100 columns wide, and go on below.
std::string answer_text(const SweepFile& sweep, const SweepAnswer& answer);
// The sentences alone, a line each. The first one answers the file's question.
std::string answer_sentences(const SweepFile& sweep, const SweepAnswer& answer);

// point, the axes' values, paradigm, measure, count, mean, half_width, difference, difference_half_width
std::string summary_csv(const SweepFile& sweep, const SweepAnswer& answer);
// point, the axes' values, replication, paradigm, status, the store's columns
std::string runs_csv(const SweepFile& sweep, const results::Store& store);

}  // namespace ttf::experiments::sweep::answers
