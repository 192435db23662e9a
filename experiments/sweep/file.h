// An experiment as one file says it: the same drives under several paradigms, over a grid of what is varied.
//
//   kind: sweep
//   name: process_noise_crossover
//   question: Is it better to measure often or to know when?
//   scenario: ../scenarios/dynamics.yaml           from this file's folder, as all files
//   seed: 1
//   replications: 1000                             of every point, each with draws of its own, the same for
//                                                  all paradigms
//   paradigms:                                     who is compared, each a drive of every point and replication
//     event_triggered: {strategy: adva}            on the scenario's cluster for it
//     time_triggered:  {strategy: tt, cluster: ../schedules/paper_synchronised.yaml, set: {duration: 2 s}}
//   axes:                                          what is varied; the grid has every combination
//     noise: {keys: [world.acceleration_noise], values: [0.5, 1, 2]}
//     speed: {keys: ["world.objects[0].speed"], from: 5, to: 20, count: 4, scale: logarithmic}   and unit: ms, or so
//     road:  {settings: {dry: {world.yaw_rate_noise: 0.05}, icy: {world.yaw_rate_noise: 0.2}}}
//     bus:   {settings: {sound: {}, torn: {faults: torn.yaml, time_triggered/tracker.process_noise: 3}}}
//     load:  {keys: [cluster.can.observation_can.other_load], uniform: [0, 0.3]}   no grid: drawn once a replication
//   measures: [position_rmse_truth, nees]          experiments/sweep/measures.h; the first is what is asked for; all
//                                                  where this is absent
//   compare: {baseline: event_triggered, confidence: 0.95}
//   stop: {half_width: 0.002, batch: 50}           a point has enough when the first measure's differences are
//                                                  that sure
//   expect:                                        what must come out, or the command exits with 1
//     - {measure: position_rmse_truth, less: time_triggered, than: event_triggered, where: {noise: 2}}
//     - {measure: position_mse_truth, agrees: position_mse_expected, of: event_triggered}   within the interval
//
// A key leads to a scalar of the scenario that is written there, "world.objects[0].speed"; of the paradigm's cluster
// where it begins with "cluster."; each is set in one place only. The values of an axis with several keys go to all of
// them. `scenario`, `cluster` and `faults` are keys, too, whose values are files: another scenario, another cluster,
// and a plan of what goes wrong, {faults: [...]}, for a scenario that has none of its own. Behind a paradigm's name and
// a slash a key is that paradigm's only, "time_triggered/cluster.sensors.laser.repetition".
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fusion/strategies/strategy.h"

namespace ttf::experiments::sweep {

struct Edit {
  std::string key, value;
  std::string paradigm;  // whose only; empty: of all
  int line = 0;          // in the experiment's file
};
// Keys whose values are files, as paths that can be opened.
inline constexpr std::string_view kScenarioFile = "scenario", kClusterFile = "cluster", kFaultsFile = "faults";
inline bool is_file(const Edit& edit) {
  return edit.key == kScenarioFile || edit.key == kClusterFile || edit.key == kFaultsFile;
}

struct Setting {
  std::string label;             // how tables and expectations call it
  std::optional<double> number;  // where the label is one
  std::vector<Edit> edits;
};

struct Axis {
  std::string name;
  std::vector<Setting> settings;  // of a random axis: none
  bool logarithmic = false;
  // Random: uniformly from `low` to `high`, to all keys.
  std::vector<Edit> keys;  // without values
  double low = 0.0, high = 0.0;
  std::string unit;  // behind numbers; may be empty
  bool random() const { return settings.empty(); }
};

struct Paradigm {
  std::string name;
  fusion::strategies::StrategyKind strategy{};
  std::optional<std::string> cluster_file;  // none: the scenario's for the strategy
  std::vector<Edit> edits;
};

struct StopRule {
  double half_width = 0.0;  // of the intervals of differences from the baseline, in the measure's unit
  std::uint32_t batch = 0;  // replications after which it is looked at
};

struct Expectation {
  // Of paradigm `less` the measure is less than of paradigm `than`; or, where there is none, of paradigm `less` it
  // agrees with the measure `agrees`: nothing is known against their being the same on the average.
  std::string measure, less, than, agrees;
  std::map<std::string, std::string> where;  // axis, label; of axes that are not named: everywhere
  std::string text;
};

struct SweepFile {
  std::string name, question, file, text;
  std::string scenario_file;
  std::uint64_t seed = 0;
  std::uint32_t replications = 0;   // of every point; more or fewer may be asked for than the file says
  std::vector<Paradigm> paradigms;  // the baseline is one of them
  std::vector<Axis> axes;
  std::vector<std::string> measures;
  std::size_t baseline = 0;
  double confidence = 0.95;
  std::optional<StopRule> stop;
  std::vector<Expectation> expectations;

  std::vector<const Axis*> grid() const;   // axes that are not random, in the file's order
  std::vector<const Axis*> drawn() const;  // random ones
  std::size_t points() const;              // of the grid
  std::uint64_t runs() const;              // all there are, without a stop rule
  // The setting of every grid axis at a point; the last axis counts on first.
  std::vector<const Setting*> settings_of(std::uint32_t point) const;
  // "noise 2, road icy".
  std::string label_of(std::uint32_t point) const;
};

inline constexpr std::size_t kMostPoints = 10'000;
inline constexpr std::uint64_t kMostRuns = 100'000'000;
inline constexpr std::uint32_t kMostReplications = 10'000'000;

// Both throw InputError with every finding.
SweepFile load_sweep(const std::string& path);
SweepFile parse_sweep(std::string text, std::string name);

}  // namespace ttf::experiments::sweep
