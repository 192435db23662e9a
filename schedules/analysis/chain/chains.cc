#include "schedules/analysis/chain/chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "schedules/analysis/age_stages.h"
#include "schedules/analysis/chain/ways.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis::chain {
namespace {

// Whether the earliest and the latest walk of every scheduled measurement end at the same instant.
bool is_exact(const model::Cluster& cluster, const Path& path) {
  const model::Sensor& sensor = cluster.sensor(path.sensor);
  if (!sensor.scheduled || path.used == 0) return false;
  const std::int64_t from = first_analysed(cluster.flexray);
  for (std::int64_t cycle = from; cycle < from + cycles_per_round(cluster.flexray); ++cycle) {
    if (!in_cycle(sensor.at, cycle)) continue;
    const std::int64_t start = time_of(cluster.flexray, cycle, sensor.at.offset).ns;
    const auto end = [&](bool latest) { return walk(cluster, path, 0, path.used, start, latest, false).back(); };
    if (end(true) != end(false)) return false;
  }
  return true;
}

Duration between_pictures(const model::Cluster& cluster, SensorId id) {
  const model::Sensor& sensor = cluster.sensor(id);
  const ClockBounds clocks = clock_bounds(cluster);
  const Duration period = sensor.longest_period();
  return period + Duration{sensor.scheduled ? clocks.apart_ns : clocks.drift_ns(period.ns)};
}

bool has_modes(const model::Cluster& cluster) {
  return std::ranges::any_of(cluster.nodes, [](const model::Node& node) {
    return std::ranges::any_of(node.tasks, [](const model::Task& task) { return !task.modes.empty(); });
  });
}

}  // namespace

std::vector<Chain> chains(const model::Cluster& cluster) {
  std::vector<Chain> found;
  std::vector<Path> paths;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const auto sensor = static_cast<SensorId>(s);
    for (const std::vector<Reading>& way : ways_to_actuators(cluster, sensor)) {
      if (found.size() >= kMostChains) break;
      Path path = path_along(cluster, sensor, way);
      if (path.stages.empty()) continue;
      Chain& chain = found.emplace_back();
      chain.sensor = sensor;
      chain.name = name_of(cluster, sensor, way);
      chain.command = way.back().out->pdu;
      chain.fused = path.held;
      chain.exact = is_exact(cluster, path);
      chain.between_pictures = between_pictures(cluster, sensor);
      paths.push_back(std::move(path));
    }
  }
  if (found.empty()) return found;
  std::vector<AgePath> ages = ages_along(cluster, paths);
  for (std::size_t c = 0; c < found.size(); ++c) found[c].path = std::move(ages[c]);
  return found;
}

std::string chains_text(const model::Cluster& cluster, Duration dead_time) {
  const std::vector<Chain> all = chains(cluster);
  if (all.empty()) return "";
  std::string text = fmt::format("{:<52}{:>10}{:>10}\n", "chain from a picture to the actuator [ms]", "best", "worst");
  const auto row = [&](const std::string& name, std::optional<Duration> best, Duration worst) {
    text += fmt::format("{:<52}{:>10}{:>10.3f}\n", name, best ? fmt::format("{:.3f}", in_ms(*best)) : "", in_ms(worst));
  };
  const bool dead = dead_time != Duration{};
  for (const Chain& chain : all) {
    text += fmt::format("{} ({})\n", chain.name, chain.exact ? "exact" : "bound");
    for (const Contribution& part : chain.path.to_use) row("    " + part.name, part.best, part.worst);
    if (dead) row("    the actuator's dead time", dead_time, dead_time);
    const std::string held = ", if held for order (BUFF)";
    const bool all_pictures = chain.looks_at_all();
    row(all_pictures ? "  first picture to first command" : "  picture looked at to first command",
        chain.reduced_reaction_best() + dead_time, chain.reduced_reaction_worst() + dead_time);
    if (all_pictures) {
      row("  reaction time, from the event", std::nullopt, chain.reaction_worst() + dead_time);
      row("  data age when a command is read", chain.path.use_best, chain.reduced_age_worst());
      row("  data age until the next command is read", std::nullopt, chain.age_worst());
    }
    if (!chain.fused) continue;
    row("  first command" + held, std::nullopt, chain.reduced_reaction_worst(true) + dead_time);
    if (!all_pictures) continue;
    row("  reaction time" + held, std::nullopt, chain.reaction_worst(true) + dead_time);
    row("  data age when read" + held, std::nullopt, chain.reduced_age_worst(true));
  }
  if (has_modes(cluster))
    text += "How often a detector looks at a camera depends on its mode: bounds from the event on follow by mode.\n";
  else if (!std::ranges::all_of(all, &Chain::looks_at_all))
    text +=
        "How often a detector looks at a camera is not known: its chains have no bound from the event on.\n"
        "`ttfusion schedule sequence --cluster` has one for a table of detections.\n";
  if (all.size() == kMostChains) text += fmt::format("more than {} chains: the others are left out\n", kMostChains);
  text +=
      "All of it provided that the event is detected in the first picture. The filter's lag comes on top: it depends "
      "on\n"
      "process noise and intervals, which the scenario has";
  text += dead ? ".\n" : ", as the actuator's dead time (--scenario).\n";
  return text;
}

}  // namespace ttf::schedules::analysis::chain
