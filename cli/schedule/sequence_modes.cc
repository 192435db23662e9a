#include "cli/schedule/sequence_modes.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "cli/shipped.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/model/ports.h"
#include "schedules/modes/mode_text.h"
#include "schedules/modes/stated.h"

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
  schedules::modes::Grid grid;
  std::vector<Mode> modes;

  schedules::modes::SoundModes sound(const ModesAsked& asked) const { return {detector, grid, &modes, asked.sensors}; }
};

// The detections of a task that time activates begin in the same cycles of a step as it does.
int base_cycle_of(const schedules::model::Cluster& cluster, const Detector& detector,
                  const schedules::modes::Grid& grid) {
  const schedules::model::Activation& activation = detector.task->activation;
  const std::int64_t cycles = grid.step.ns / cluster.cycle().ns;
  return is_by_time(activation) ? static_cast<int>(activation.at.base_cycle % cycles) : 0;
}

Checked checked(const ModesAsked& asked) {
  Checked found;
  found.cluster = schedules::check::load_checked_cluster(file_named(asked.cluster, {kSchedules}));
  found.detector = detector_of(found.cluster, asked.task);
  if (const Duration cycle = found.cluster.cycle(); asked.grid.step.ns % cycle.ns != 0)
    refuse_modes("--step", scaled_text(asked.grid.step.ns, 1'000'000) + " ms",
                 fmt::format("must be a multiple of the communication cycle, {} ms", scaled_text(cycle.ns, 1'000'000)));
  found.grid = asked.grid;
  found.grid.base_cycle = base_cycle_of(found.cluster, found.detector, asked.grid);
  for (std::size_t m = 0; m < asked.sequences.size(); ++m) {
    Mode& mode = found.modes.emplace_back(placed(found.cluster, asked.sequences[m], asked.times, found.grid));
    mode.name = letters(mode.sequence, asked.sensors);
    mode.bound = asked.bounds[m];
  }
  Findings findings;
  for (Finding& one : unsound(found.cluster, found.detector, found.modes, found.grid)) findings.add(std::move(one));
  findings.throw_if_any();
  return found;
}

void print_json(const ModesAsked& asked, const Checked& found) {
  nlohmann::ordered_json json{{"cluster", found.cluster.name},
                              {"task", asked.task},
                              {"step_ms", in_ms(asked.grid.step)},
                              {"offset", asked.grid.offset.value}};
  for (const Mode& mode : found.modes) {
    nlohmann::ordered_json one{{"sequence", mode.name},
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
  const std::vector<std::string> chains = chain_names(found.cluster, found.detector);
  for (std::size_t c = 0; c < chains.size(); ++c) {
    nlohmann::ordered_json chain{{"chain", chains[c]}};
    for (const auto& row : bounds_by_mode(found.cluster, found.sound(asked), c))
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

// The letters of the sensors stand for the cameras of the task, in the order of its ports.
void print_yaml(const ModesAsked& asked, const Checked& found) {
  const std::size_t cameras = camera_ports(*found.detector.task).size();
  if (cameras != asked.sensors.size())
    refuse_modes("--yaml", asked.task,
                 fmt::format("needs a task that reads a list of each of the {} cameras and writes one, as "
                             "adaptive_camera does; this one does so for {}",
                             asked.sensors.size(), cameras));
  fmt::print("{}", yaml_text(found.cluster, found.detector, found.modes, found.grid));
}

}  // namespace

void print_modes(const ModesAsked& asked) {
  const Checked found = checked(asked);
  if (asked.json) return print_json(asked, found);
  if (asked.yaml) return print_yaml(asked, found);
  for (const Mode& mode : found.modes) {
    fmt::print("mode {} for a bound of {:g} ms: a frame of {:g} ms, {} cycles\n{}", mode.name, in_ms(mode.bound),
               in_ms(mode.frame), mode.cycles, instants_text(mode, found.sound(asked)));
  }
  fmt::print(
      "consistent with {}: detections end within their steps, and no list of {} is torn or replaced, "
      "whenever modes change at a frame's end; lists {}\n{}",
      found.cluster.name, asked.task,
      asked.grid.best_case ? "may leave when their detections end" : "wait for their detections' worst cases",
      bounds_text(found.cluster, found.sound(asked)));
}

}  // namespace ttf::cli::schedule
