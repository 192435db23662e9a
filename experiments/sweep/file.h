// The file of an experiment: the same drives under several paradigms, over a grid of variations.
//
//   kind: sweep
//   name: process_noise_crossover
//   question: Is it better to measure often or to know when?
//   scenario: ../scenarios/dynamics.yaml           from this file's folder, as all files
//   seed: 1
//   replications: 1000                             of every point, each with draws of its own, the same for
//                                                  all paradigms
//   paradigms:                                     are compared; each drives every point and replication
//     event_triggered: {strategy: adva}            on the scenario's cluster for it
//     time_triggered:  {strategy: tt, cluster: ../schedules/paper_synchronised.yaml, set: {duration: 2 s}}
//   axes:                                          are varied; the grid has every combination
//     noise: {keys: [world.acceleration_noise], values: [0.5, 1, 2]}
//     speed: {keys: ["world.objects[0].speed"], from: 5, to: 20, count: 4, scale: logarithmic}   and unit: ms, or so
//     road:  {settings: {dry: {world.yaw_rate_noise: 0.05}, icy: {world.yaw_rate_noise: 0.2}}}
//     bus:   {settings: {sound: {}, torn: {faults: torn.yaml, time_triggered/tracker.process_noise: 3}}}
//     load:  {keys: [cluster.can.observation_can.other_load], uniform: [0, 0.3]}   no grid: drawn once a replication
//   measures: [position_rmse_truth, nees]          evaluation/measures/table.cc; the first one decides; all of them
//                                                  if absent
//   compare: {baseline: event_triggered, confidence: 0.95}
//                                                  or the values of an axis: {axis: noise, baseline: "0.5"}
//   interactions:                                  whether a change of an axis lowers a measure of one paradigm more; the
//                                                  first measure, and from the axis's first value to its last, if absent
//     - {measure: nees, axis: noise, from: "2", to: "0.5", lowers: time_triggered, more_than: event_triggered, by: ratio}
//   stop: {half_width: 0.002, batch: 50}           ends a point when the intervals of the first measure's
//                                                  differences are that narrow
//   expect:                                        must hold, or the command exits with 1
//     - {measure: position_rmse_truth, less: time_triggered, than: event_triggered, where: {noise: 2}}
//     - {measure: position_mse_truth, agrees: position_mse_expected, of: event_triggered, margin: 5 %}
//
// A key names a scalar that is written in the scenario's file, "world.objects[0].speed", or, if it begins with
// "cluster.", in the paradigm's cluster file. No key may be set twice. An axis gives its values to all its keys.
// `scenario`, `cluster` and `faults` are keys, too, and their values are files: another scenario, another cluster,
// and a fault plan, {faults: [...]}, for a scenario without its own. A paradigm's name and a slash restrict a key to
// that paradigm, "time_triggered/cluster.sensors.laser.repetition".
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "experiments/results/equivalence.h"
#include "fusion/strategies/strategy.h"

namespace ttf::experiments::sweep {

// An experiment compares paradigms, the values of one axis, or an axis's effects on two paradigms.

// Each paradigm at a value of the axis is compared with itself at the axis's baseline, all else equal.
struct AxisComparison {
  std::size_t axis = 0;      // in SweepFile::grid()
  std::size_t baseline = 0;  // in its settings
};

// A change by kRatio is a share of the value before, so that two changes are compared by the ratio of their factors. A change
// by kDifference is in the measure's unit.
enum class Scale : std::uint8_t { kRatio, kDifference };

// Whether the change of an axis from one value to another lowers a measure of paradigm `first` more than of `second`.
struct Interaction {
  std::size_t measure = 0;            // in SweepFile::measures
  std::size_t axis = 0;               // in SweepFile::grid()
  std::size_t before = 0, after = 0;  // in the axis's settings
  std::size_t first = 0, second = 0;  // in SweepFile::paradigms
  Scale scale = Scale::kRatio;
};

// A paradigm at a point, with which another one is compared.
struct Reference {
  std::uint32_t point = 0;
  std::size_t paradigm = 0;
};

struct Edit {
  std::string key, value;
  std::string paradigm;  // restricts the edit; empty: all paradigms
  int line = 0;          // in the experiment's file
};
// Keys whose values are files, as paths that can be opened.
inline constexpr std::string_view kScenarioFile = "scenario", kClusterFile = "cluster", kFaultsFile = "faults";
inline bool is_file(const Edit& edit) {
  return edit.key == kScenarioFile || edit.key == kClusterFile || edit.key == kFaultsFile;
}

struct Setting {
  std::string label;             // in tables and expectations
  std::optional<double> number;  // the label, if it is a number
  std::vector<Edit> edits;
};

struct Axis {
  std::string name;
  std::vector<Setting> settings;  // empty for a random axis
  bool logarithmic = false;
  // Random: drawn uniformly from `low` to `high`, for all keys.
  std::vector<Edit> keys;  // without values
  double low = 0.0, high = 0.0;
  std::string unit;  // follows numbers; may be empty
  bool random() const { return settings.empty(); }
};

struct Paradigm {
  std::string name;
  fusion::strategies::StrategyKind strategy{};
  std::optional<std::string> cluster_file;  // absent: the scenario's for the strategy
  int cluster_line = 0;
  std::vector<Edit> edits;
};

struct StopRule {
  double half_width = 0.0;  // for the intervals of differences from the baseline, in the measure's unit
  std::uint32_t batch = 0;  // replications between two judgements
};

struct Expectation {
  // The measure is less for paradigm `less` than for paradigm `than`. Without `than`, the measure agrees for
  // paradigm `less` with the measure `agrees`: their mean difference is certainly within the margin.
  std::string measure, less, than, agrees;
  results::Margin margin = {};
  std::map<std::string, std::string> where;  // axis, label; absent axes: everywhere
  std::string text;
};

struct SweepFile {
  std::string name, question, file, text;
  std::string scenario_file;
  int scenario_line = 0;
  std::uint64_t seed = 0;
  std::uint32_t replications = 0;   // at every point; the caller may change it
  std::vector<Paradigm> paradigms;  // the baseline is one of them
  std::vector<Axis> axes;
  std::vector<std::string> measures;
  std::size_t baseline = 0;                     // a paradigm, unless an axis is compared
  std::optional<AxisComparison> compared_axis;  // its values are compared instead of the paradigms
  std::vector<Interaction> interactions;
  double confidence = 0.95;
  std::optional<StopRule> stop;
  std::vector<Expectation> expectations;

  std::vector<const Axis*> grid() const;   // axes that are not random, in the file's order
  std::vector<const Axis*> drawn() const;  // random ones
  std::size_t points() const;              // in the grid
  std::uint64_t drives() const;            // number of drives without a stop rule
  // Returns the setting of every grid axis at a point; the last axis varies fastest.
  std::vector<const Setting*> settings_of(std::uint32_t point) const;
  // Returns the point with another setting of one axis of the grid.
  std::uint32_t moved(std::uint32_t point, std::size_t axis, std::size_t setting) const;
  // Returns what a paradigm at a point is compared with; no value for the baseline itself.
  std::optional<Reference> reference_of(std::uint32_t point, std::size_t paradigm) const;
  // "noise 2, road icy"; without one axis of the grid, "noise 2".
  std::string label_of(std::uint32_t point) const;
  std::string label_without(std::uint32_t point, std::size_t axis) const;
};

// The measure that every drive is stored with, whatever `measures` says: a lost track may be a mean's largest part.
inline constexpr std::string_view kTrackLost = "track_lost";

inline constexpr std::size_t kMostPoints = 10'000;
inline constexpr std::uint64_t kMostDrives = 100'000'000;
inline constexpr std::uint32_t kMostReplications = 10'000'000;

// All throw InputError with every finding.
SweepFile load_sweep(const std::string& path);
SweepFile parse_sweep(std::string text, std::string name);
SweepFile read_sweep(const StrictYaml& yaml);

}  // namespace ttf::experiments::sweep
