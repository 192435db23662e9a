#include "schedules/modes/stated.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/check.h"
#include "core/decimal.h"
#include "schedules/model/ports.h"
#include "schedules/model/round.h"

namespace ttf::schedules::modes {
namespace {

Mode mode_of(const model::Cluster& cluster, const model::TaskMode& stated) {
  Mode mode;
  mode.name = stated.name;
  mode.cycles = stated.cycles;
  mode.frame = mode.bound = cluster.cycle() * stated.cycles;
  for (std::size_t i = 0; i < stated.instants.size(); ++i) {
    const model::ModeInstant& one = stated.instants[i];
    const int until = i + 1 < stated.instants.size() ? stated.instants[i + 1].cycle : stated.cycles;
    const sequence::Detection detection{static_cast<int>(one.camera), one.secondary};
    mode.sequence.push_back(detection);
    mode.detections.push_back({detection, one.cycle, cluster.cycle() * one.cycle, one.lasts, one.lasts,
                               cluster.cycle() * (until - one.cycle), one.line});
  }
  return mode;
}

std::string in_ms_text(Duration time) { return scaled_text(time.ns, 1'000'000) + " ms"; }

}  // namespace

std::vector<StatedModes> stated_modes(const model::Cluster& cluster) {
  std::vector<StatedModes> found;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (const model::Task& task : cluster.nodes[n].tasks) {
      if (task.modes.empty()) continue;
      StatedModes& one = found.emplace_back();
      one.detector = {static_cast<NodeId>(n), &task, true};
      const model::CycleInstant& at = task.activation.at;
      one.grid = {cluster.cycle() * at.repetition, at.offset, std::nullopt, at.base_cycle};
      for (const model::TaskMode& mode : task.modes) one.modes.push_back(mode_of(cluster, mode));
    }
  return found;
}

std::string camera_letters(std::size_t cameras) {
  std::string letters(std::min(cameras, static_cast<std::size_t>(sequence::kMostSensors)), 'A');
  std::iota(letters.begin(), letters.end(), 'A');
  return letters;
}

std::string yaml_text(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes,
                      const Grid& grid) {
  TTF_CHECK(!modes.empty() && !modes.front().detections.empty(), "{} modes", modes.size());
  const std::vector<const model::PortBinding*> cameras = camera_ports(*detector.task);
  Duration best = modes.front().detections.front().worst_case, worst{};
  std::string frames;
  std::set<std::string> known;
  for (const Mode& mode : modes) {
    if (!known.insert(mode.name).second) continue;
    frames += fmt::format("          {}:\n            frame: {}\n            detections:\n", mode.name, mode.cycles);
    for (const PlacedDetection& one : mode.detections) {
      best = std::min(best, one.worst_case);
      worst = std::max(worst, one.worst_case);
      frames += fmt::format("              - {{cycle: {}, camera: {}, look: {}, lasts: {}}}\n", one.cycle,
                            cameras.at(static_cast<std::size_t>(one.detection.sensor))->port,
                            one.detection.secondary ? "secondary" : "primary", in_ms_text(one.worst_case));
    }
  }
  const std::int64_t repetition =
      std::gcd<std::int64_t>(cycles_per_round(cluster.flexray), grid.step.ns / cluster.cycle().ns);
  const std::string keys =
      fmt::format("activation: {{kind: modes, base_cycle: {}, repetition: {}, offset: {}}}\n",
                  grid.base_cycle % repetition, repetition, grid.offset.value) +
      fmt::format("        best_case: {}\n        worst_case: {}\n        draw: worst\n        deadline: {}\n",
                  in_ms_text(best), in_ms_text(worst), in_ms_text(worst));
  return fmt::format("        {}        modes:\n{}", keys, frames);
}

}  // namespace ttf::schedules::modes
