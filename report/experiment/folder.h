// An experiment's results: the content of answer.json, and the drives in results.sqlite.
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

// The estimate for one paradigm and measure at one point; the baseline has no difference.
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
  std::string outcome;                 // "cannot tell"; "" in an older answer.json
  std::vector<std::string> where_not;  // points
  std::vector<std::string> why_not;    // the same points' reasons; none in an older answer.json
};

struct ExperimentMeasure {
  std::string name, unit, meaning;  // an older answer.json has only the name
  std::string with_unit() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct ExperimentFolder {
  std::string path, name, question, answer, baseline;
  std::string file;  // the experiment's file, by its name then; "" in an older answer.json
  std::uint64_t seed = 0, drives = 0, failed = 0;
  double confidence = 0.95;
  std::vector<std::string> axes, paradigms;  // in the file's order
  std::vector<ExperimentMeasure> measures;   // the first is the measure in question
  std::vector<ExperimentPoint> points;
  std::vector<ExperimentCrossing> crossings;
  std::vector<ExperimentExpectation> expectations;
  std::optional<experiments::results::Store> store;  // no value without results.sqlite
};

// Throws InputError with the file, the key and the requirement.
ExperimentFolder read_experiment_folder(const std::string& path);

// Reads answer.json alone; `file` is for messages. Throws InputError.
ExperimentFolder parse_answer(std::string_view text, const std::string& file);
// Opens the answer's drives if the file exists. Throws InputError.
void read_store(const std::string& path, ExperimentFolder& folder);

}  // namespace ttf::report::experiment
