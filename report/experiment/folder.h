// An experiment's results: the content of answer.json, and the drives in results.sqlite.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/results/outcome.h"
#include "experiments/results/ratio.h"
#include "experiments/results/statistics.h"
#include "experiments/results/store.h"

namespace ttf::report::experiment {

// The estimate for one paradigm and measure at one point; the baseline has no difference.
struct Estimate {
  experiments::results::Interval mean;
  std::optional<experiments::results::Interval> difference;
};

// Returns "12.3 ± 0.4", or "0.02 (0.005 to 0.07)" if the interval is uneven. `runs`: more drives than have a value are
// marked, "12.3 ± 0.4 of 180".
std::string interval_words(const experiments::results::Interval& interval, bool sign = false, std::uint64_t runs = 0);

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
  std::optional<experiments::results::Outcome> outcome;  // none in an older answer.json
  std::vector<std::string> where_not;                    // points
  std::vector<std::string> why_not;                      // the same points' reasons; none in an older answer.json
};

// A change in the measure's unit, or in per cent; an interval that is not there is not a number.
struct ExperimentChange {
  experiments::results::Interval difference;           // by ratio, of an interaction: a natural logarithm
  std::optional<experiments::results::Ratio> percent;  // value and ends are in per cent
};
struct InteractionPoint {
  std::vector<std::string> settings;  // by the other axes
  ExperimentChange first, second, interaction;
  bool stays = false;
};
// Whether a change of an axis lowers a measure of one paradigm more than of another.
struct ExperimentInteraction {
  std::string measure, by, axis, from, to, lowers, more_than;
  std::vector<std::string> others;  // the other axes
  std::vector<InteractionPoint> points;
};

struct ExperimentMeasure {
  std::string name, unit, meaning;  // an older answer.json has only the name
  std::string with_unit() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct ExperimentFolder {
  std::string path, name, question, answer, baseline;
  std::string compared_axis;           // `baseline` is one of its values; "": the paradigms are compared
  std::string file;                    // the experiment's file, by its name then; "" in an older answer.json
  std::vector<std::string> libraries;  // those of steps, by name
  std::uint64_t seed = 0, drives = 0, failed = 0;
  double confidence = 0.95;
  std::vector<std::string> axes, paradigms;  // in the file's order
  std::vector<ExperimentMeasure> measures;   // the first is the measure in question
  std::vector<ExperimentPoint> points;
  std::vector<ExperimentCrossing> crossings;
  std::vector<ExperimentInteraction> interactions;
  std::vector<ExperimentExpectation> expectations;
  std::optional<experiments::results::Store> store;  // no value without results.sqlite

  // "adva", or "camera 80" where an axis is compared.
  std::string baseline_name() const { return compared_axis.empty() ? baseline : compared_axis + " " + baseline; }
  // Returns whether the answer's first sentence answers the question, rather than the pairs of paradigms.
  bool asks_more() const { return !compared_axis.empty() || !interactions.empty(); }
};

// Throws InputError with the file, the key and the requirement.
ExperimentFolder read_experiment_folder(const std::string& path);

// Reads answer.json alone; `file` is for messages. Throws InputError.
ExperimentFolder parse_answer(std::string_view text, const std::string& file);
// Opens the answer's drives if the file exists. Throws InputError.
void read_store(const std::string& path, ExperimentFolder& folder);

}  // namespace ttf::report::experiment
