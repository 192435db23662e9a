#include "cli/schedule/sequence_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/shipped.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "schedules/analysis/chain/rest.h"
#include "schedules/check/checker.h"

namespace ttf::cli::schedule {
namespace {

using schedules::modes::CameraBound;
using schedules::modes::Detector;
using schedules::modes::Mode;
using schedules::modes::PlacedDetection;

[[noreturn]] void refuse_modes(const char* option, const std::string& value, const std::string& expected) {
  throw InputError(Finding{"command line", 0, option, value, expected});
}

Detector detector_of(const schedules::model::Cluster& cluster, const std::string& typed) {
  const std::size_t dot = typed.find('.');
  if (const auto node = cluster.find_node(typed.substr(0, dot)); node && dot != std::string::npos)
    for (const schedules::model::Task& task : cluster.node(*node).tasks)
      if (task.name == typed.substr(dot + 1)) return {*node, &task};
  refuse_modes("--task", typed,
               fmt::format("must be a node and its task in {}, as in camera_pre.preprocess", cluster.file));
}

struct Checked {
  schedules::model::Cluster cluster;
  Detector detector;
  std::vector<Mode> modes;
  std::vector<std::string> chains;
};

Checked checked(const ModesAsked& asked) {
  Checked found;
  found.cluster = schedules::check::load_checked_cluster(file_named(asked.cluster, {kSchedules}));
  found.detector = detector_of(found.cluster, asked.task);
  if (const Duration cycle = found.cluster.cycle(); asked.grid.step.ns % cycle.ns != 0)
    refuse_modes("--step", scaled_text(asked.grid.step.ns, 1'000'000) + " ms",
                 fmt::format("must be a multiple of the communication cycle, {} ms", scaled_text(cycle.ns, 1'000'000)));
  for (std::size_t m = 0; m < asked.sequences.size(); ++m) {
    found.modes.push_back(placed(found.cluster, asked.sequences[m], asked.times, asked.grid));
    found.modes.back().bound = asked.bounds[m];
  }
  Findings findings;
  for (Finding& one : unsound(found.cluster, found.detector, found.modes, asked.grid)) findings.add(std::move(one));
  findings.throw_if_any();
  for (const auto& rest :
       schedules::analysis::chain::rests_behind(found.cluster, found.detector.node, *found.detector.task))
    found.chains.push_back(rest.name());
  return found;
}

// A row for each mode, and one for each change from a mode to another, in a chain.
struct Rows {
  std::string name;
  std::vector<CameraBound> cameras;
};
std::vector<Rows> rows_of(const ModesAsked& asked, const Checked& found, std::size_t chain) {
  std::vector<Rows> rows;
  for (const Mode& mode : found.modes)
    rows.push_back(
        {letters(mode.sequence, asked.sensors), bounds(found.cluster, found.detector, mode, asked.grid, chain)});
  for (const Mode& before : found.modes)
    for (const Mode& after : found.modes)
      if (&before != &after)
        rows.push_back(
            {fmt::format("{} then {}", letters(before.sequence, asked.sensors), letters(after.sequence, asked.sensors)),
             bounds_of_change(found.cluster, found.detector, before, after, asked.grid, chain)});
  return rows;
}

void print_json(const ModesAsked& asked, const Checked& found) {
  nlohmann::ordered_json json{{"cluster", found.cluster.name},
                              {"task", asked.task},
                              {"step_ms", in_ms(asked.grid.step)},
                              {"offset", asked.grid.offset.value}};
  for (const Mode& mode : found.modes) {
    nlohmann::ordered_json one{{"sequence", letters(mode.sequence, asked.sensors)},
                               {"bound_ms", in_ms(mode.bound)},
                               {"frame_ms", in_ms(mode.frame)},
                               {"frame_cycles", mode.cycles}};
    for (const PlacedDetection& detection : mode.detections)
      one["activations"].push_back({{"detection", schedules::sequence::letters({detection.detection}, asked.sensors)},
                                    {"cycle", detection.cycle},
                                    {"offset", asked.grid.offset.value},
                                    {"best_case_ms", in_ms(detection.best_case)},
                                    {"worst_case_ms", in_ms(detection.worst_case)},
                                    {"occupied_ms", in_ms(detection.occupied)}});
    json["modes"].push_back(std::move(one));
  }
  for (std::size_t c = 0; c < found.chains.size(); ++c) {
    nlohmann::ordered_json chain{{"chain", found.chains[c]}};
    for (const Rows& row : rows_of(asked, found, c))
      for (const CameraBound& camera : row.cameras)
        chain["bounds"].push_back({{"mode", row.name},
                                   {"sensor", std::string(1, asked.sensors[static_cast<std::size_t>(camera.sensor)])},
                                   {"reduced_reaction_time_ms", {in_ms(camera.least), in_ms(camera.most)}},
                                   {"reaction_time_in_region_ms", in_ms(camera.reaction_in_region)},
                                   {"reaction_time_ms", in_ms(camera.reaction)}});
    json["chains"].push_back(std::move(chain));
  }
  fmt::print("{}\n", json.dump(2));
}

void print_mode(const ModesAsked& asked, const Mode& mode) {
  fmt::print("mode {} for a bound of {:g} ms: a frame of {:g} ms, {} cycles\n", letters(mode.sequence, asked.sensors),
             in_ms(mode.bound), in_ms(mode.frame), mode.cycles);
  fmt::print("  detection   cycle  offset  begins [ms]  list at most [ms]  occupied until [ms]\n");
  for (const PlacedDetection& one : mode.detections) {
    const Duration begins = one.begins;
    fmt::print("  {:<9}  {:>6}  {:>6}  {:>11.3f}  {:>17.3f}  {:>19.3f}\n",
               schedules::sequence::letters({one.detection}, asked.sensors), one.cycle, asked.grid.offset.value,
               in_ms(begins), in_ms(begins + one.worst_case), in_ms(begins + one.occupied));
  }
}

}  // namespace

void print_modes(const ModesAsked& asked) {
  const Checked found = checked(asked);
  if (asked.json) return print_json(asked, found);
  for (const Mode& mode : found.modes) print_mode(asked, mode);
  fmt::print(
      "consistent with {}: detections end within their steps, and no list of {} is torn or replaced, "
      "whenever modes change at a frame's end; lists {}\n",
      found.cluster.name, asked.task,
      asked.grid.best_case ? "may leave when their detections end" : "wait for their detections' worst cases");
  if (found.chains.empty()) fmt::print("no chain leads from {} to an actuator\n", asked.task);
  for (std::size_t c = 0; c < found.chains.size(); ++c) {
    const std::vector<Rows> rows = rows_of(asked, found, c);
    std::size_t wide = 4;
    for (const Rows& row : rows) wide = std::max(wide, row.name.size());
    fmt::print("{}, for BUFF without its waiting [ms]\n", found.chains[c]);
    fmt::print("  {:<{}}  camera  first picture to first command  reaction time in region  anywhere\n", "mode", wide);
    for (const Rows& row : rows)
      for (const CameraBound& camera : row.cameras)
        fmt::print("  {:<{}}  {:<6}  {:>30}  {:>23.3f}  {:>8.3f}\n", row.name, wide,
                   asked.sensors[static_cast<std::size_t>(camera.sensor)],
                   fmt::format("{:.3f}..{:.3f}", in_ms(camera.least), in_ms(camera.most)),
                   in_ms(camera.reaction_in_region), in_ms(camera.reaction));
  }
}

}  // namespace ttf::cli::schedule
