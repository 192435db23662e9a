// An experiment's results: what answer.json says, and the runs in results.sqlite.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/results/statistics.h"
#include "experiments/results/store.h"

namespace ttf::report::experiment {

// Of one paradigm and measure at one point; without a difference: the baseline.
struct Estimate {
  experiments::results::Interval mean;
  std::optional<experiments::results::Interval> difference;
};

struct ExperimentPoint {
  std::uint32_t point = 0;
  std::vector<std::string> settings;             // by axis
  std::vector<std::vector<Estimate>> estimates;  // by paradigm, then measure
};

struct ExperimentCrossing {
  std::string paradigm, axis, others;
  double at = 0.0;
  bool certain = false;
};

struct ExperimentExpectation {
  std::string expected;
  bool holds = false;
  std::vector<std::string> where_not;
};

struct ExperimentMeasure {
  std::string name, unit, meaning;  // of an older answer.json the name alone
  std::string with_unit() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct ExperimentFolder {
  std::string path, name, question, answer, baseline;
  std::string file;  // the experiment's, as it was named then; "" in older ones
  std::uint64_t seed = 0, runs = 0, failed = 0;
  double confidence = 0.95;
  std::vector<std::string> axes, paradigms;  // in the file's order
  std::vector<ExperimentMeasure> measures;   // the first is what is asked for
  std::vector<ExperimentPoint> points;
  std::vector<ExperimentCrossing> crossings;
  std::vector<ExperimentExpectation> expectations;
  std::optional<experiments::results::Store> store;  // none where there is no results.sqlite
};

// Throws InputError: the file, the key and what it must be.
ExperimentFolder read_experiment_folder(const std::string& path);

// What answer.json says by itself; `file` is for messages. Throws InputError.
ExperimentFolder parse_answer(std::string_view text, const std::string& file);
// The runs that the answer is of, where there is such a file. Throws InputError.
void read_store(const std::string& path, ExperimentFolder& folder);

}  // namespace ttf::report::experiment
