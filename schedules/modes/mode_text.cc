#include "schedules/modes/mode_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/time.h"
#include "schedules/analysis/chain/rest.h"
#include "schedules/model/ports.h"
#include "schedules/modes/stated.h"

namespace ttf::schedules::modes {
namespace {

std::string task_name(const model::Cluster& cluster, const Detector& detector) {
  return fmt::format("{}.{}", cluster.node(detector.node).name, detector.task->name);
}

}  // namespace

std::vector<BoundsOfMode> bounds_by_mode(const model::Cluster& cluster, const SoundModes& sound, std::size_t chain) {
  std::vector<BoundsOfMode> rows;
  for (const Mode& mode : *sound.modes)
    rows.push_back({mode.name, bounds(cluster, sound.detector, mode, sound.grid, chain)});
  for (const Mode& before : *sound.modes)
    for (const Mode& after : *sound.modes)
      if (&before != &after)
        rows.push_back({fmt::format("{} then {}", before.name, after.name),
                        bounds_of_change(cluster, sound.detector, before, after, sound.grid, chain)});
  return rows;
}

std::vector<std::string> chain_names(const model::Cluster& cluster, const Detector& detector) {
  std::vector<std::string> names;
  for (const auto& rest : analysis::chain::rests_behind(cluster, detector.node, *detector.task))
    names.push_back(rest.name());
  return names;
}

std::string instants_text(const Mode& mode, const SoundModes& sound) {
  std::string text = "  detection   cycle  offset  begins [ms]  list at most [ms]  occupied until [ms]\n";
  for (const PlacedDetection& one : mode.detections)
    text += fmt::format("  {:<9}  {:>6}  {:>6}  {:>11.3f}  {:>17.3f}  {:>19.3f}\n",
                        sequence::letters({one.detection}, sound.letters), one.cycle, sound.grid.offset.value,
                        in_ms(one.begins), in_ms(one.begins + one.worst_case), in_ms(one.begins + one.occupied));
  return text;
}

std::string bounds_text(const model::Cluster& cluster, const SoundModes& sound) {
  const std::vector<std::string> chains = chain_names(cluster, sound.detector);
  if (chains.empty()) return fmt::format("no chain leads from {} to an actuator\n", task_name(cluster, sound.detector));
  std::string text;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const std::vector<BoundsOfMode> rows = bounds_by_mode(cluster, sound, c);
    std::size_t wide = 4;
    for (const BoundsOfMode& row : rows) wide = std::max(wide, row.name.size());
    text += fmt::format("{}, for BUFF without its waiting [ms]\n", chains[c]);
    text += fmt::format("  {:<{}}  camera  first picture to first command  reaction time in region  anywhere\n", "mode",
                        wide);
    for (const BoundsOfMode& row : rows)
      for (const CameraBound& camera : row.cameras)
        text += fmt::format("  {:<{}}  {:<6}  {:>30}  {:>23.3f}  {:>8.3f}\n", row.name, wide,
                            sound.letters[static_cast<std::size_t>(camera.sensor)],
                            fmt::format("{:.3f}..{:.3f}", in_ms(camera.least), in_ms(camera.most)),
                            in_ms(camera.reaction_in_region), in_ms(camera.reaction));
  }
  return text;
}

std::string stated_text(const model::Cluster& cluster) {
  std::string text;
  for (const StatedModes& stated : stated_modes(cluster)) {
    const auto ports = camera_ports(*stated.detector.task);
    const std::string letters = camera_letters(ports.size());
    text += fmt::format("modes of {}:", task_name(cluster, stated.detector));
    for (std::size_t c = 0; c < ports.size(); ++c) text += fmt::format(" {} {}", letters[c], ports[c]->port);
    text += "\n";
    const SoundModes sound{stated.detector, stated.grid, &stated.modes, letters};
    for (const Mode& mode : stated.modes)
      text += fmt::format("mode {}: {}, a frame of {:g} ms, {} cycles\n{}", mode.name,
                          sequence::letters(mode.sequence, letters), in_ms(mode.frame), mode.cycles,
                          instants_text(mode, sound));
    text += bounds_text(cluster, sound);
  }
  return text;
}

}  // namespace ttf::schedules::modes
