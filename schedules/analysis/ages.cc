#include "schedules/analysis/ages.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "schedules/analysis/age_stages.h"
#include "schedules/analysis/settled.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

// One extreme walk from the measurement on: the share of each stage, and their sum.
struct Extreme {
  std::vector<std::int64_t> shares;
  std::int64_t sum = 0;
  std::int64_t on_grid = 0;  // the part of the sum from the first stage on the grid on
};

class Ages {
 public:
  explicit Ages(const model::Cluster& cluster) : cluster_(cluster), clocks_(clock_bounds(cluster)) {}

  std::optional<AgePath> of(SensorId id) {
    Path path = path_of(cluster_, id);
    if (path.stages.empty()) return std::nullopt;
    if (!observes(id)) path.used = 0;
    return of(path);
  }

  AgePath of(const Path& path) {
    const SensorId id = path.sensor;
    AgePath ages;
    ages.sensor = id;
    const model::Sensor& sensor = cluster_.sensor(id);
    const std::size_t last = std::max(path.used, path.fused);
    const Bounds all{extremes(path, sensor, last, false), extremes(path, sensor, last, true)};
    bounds(all, path.available, ages.fusion_best, ages.fusion_worst);
    ages.to_fusion = contributions(path, all, path.available);
    bounds(all, path.fused, ages.fused_best, ages.fused_worst);
    ages.reaches_use = path.used != 0;
    ages.chosen = path.chosen;
    for (Waypoint point : path.waypoints) {
      if (!ages.reaches_use && point.stages > path.fused) break;
      bounds(all, point.stages, point.best, point.worst);
      ages.waypoints.push_back(point);
    }
    if (!ages.reaches_use) return ages;
    bounds(all, path.used, ages.use_best, ages.use_worst);
    ages.to_use = contributions(path, all, path.used);
    ages.newest_worst = ages.use_worst + until_next_newest(path, id);
    return ages;
  }

  // Whether the sensor observes objects. Odometry measures its own vehicle: no image shows its samples.
  bool observes(SensorId id) const { return model::row_of(cluster_.sensor(id).kind).observes; }

  // BUFF releases the oldest held measurement of a sensor at `at`, `age` after the measurement.
  struct Release {
    GlobalTime at{};
    Duration age{};
  };
  void releases(SensorId sensor, std::vector<Release>& all) const {
    const auto round = settled_round(cluster_, sensor);
    if (!round) return;
    const std::vector<Settled>& settled = round->instants;
    // The oldest measurement that the next instant settles directly follows the youngest that this one settles.
    for (std::size_t i = 0; i < settled.size(); ++i) {
      const GlobalTime next = i + 1 < settled.size() ? settled[i + 1].at : settled.front().at + round->round;
      all.push_back({next, next - settled[i].measured});
    }
  }

  // For tasks activated by lists. A list waits until no slower list can precede it, and then for the next list
  // of the sensor with the shortest time between arrivals.
  Duration held_for_arrivals(const std::vector<AgePath>& paths) const {
    Duration slowest{};
    std::optional<Duration> apart;
    for (const AgePath& path : paths) {
      slowest = std::max(slowest, path.fused_worst);
      if (!path_of(cluster_, path.sensor).on_arrival) continue;
      const Duration one = longest_between(path.sensor) + path.fused_worst - path.fused_best;
      apart = std::min(apart.value_or(one), one);
    }
    return slowest + apart.value_or(Duration{});
  }

  void buffer(AgePath& ages, const Path& path, const std::vector<Release>& releases, Duration held_for_arrivals) {
    const std::size_t gate = path.available;
    std::int64_t fused = 0, used = 0;
    const std::size_t last = std::max(path.used, path.fused);
    if (path.on_arrival) return buffer(ages, path, held_for_arrivals);
    // Without activation by time there are no fusion instants to hold a list for.
    if (gate >= path.stages.size() || path.stages[gate].kind != Stage::Kind::kActivation) return;
    for (const Release& release : releases) {
      const auto instants = walk(cluster_, path, gate, last, release.at.ns, true, true);
      const std::int64_t measured = (release.at - release.age).ns;
      fused = std::max(fused, instants[path.fused - gate - 1] - measured);
      if (path.used != 0) used = std::max(used, instants.back() - measured);
    }
    const auto with_clocks = [&](std::int64_t sum) { return Duration{sum + clocks_.apart_ns + clocks_.drift_ns(sum)}; };
    ages.buffered_fused_worst = with_clocks(fused);
    if (path.used == 0) return;
    ages.buffered_use_worst = with_clocks(used);
    ages.buffered_newest_worst = ages.buffered_use_worst + until_next_newest(path, ages.sensor);
  }

 private:
  void buffer(AgePath& ages, const Path& path, Duration held) const {
    const auto with_clocks = [&](Duration sum) { return sum + Duration{clocks_.apart_ns + clocks_.drift_ns(sum.ns)}; };
    ages.buffered_fused_worst = with_clocks(held);
    if (path.used == 0) return;
    ages.buffered_use_worst = with_clocks(held + fusion_to_use(path));
    ages.buffered_newest_worst = ages.buffered_use_worst + until_next_newest(path, ages.sensor);
  }

  // Returns the worst case over all phases.
  Duration fusion_to_use(const Path& path) const {
    std::int64_t spans = 0, rest = 0;
    std::size_t gate = path.fused;
    for (; gate < path.used && !path.stages[gate].on_grid(true); ++gate) spans += path.stages[gate].worst.ns;
    if (gate == path.used) return {spans};
    for (const std::int64_t start : entries(cluster_, path.stages[gate], first_analysed(cluster_.flexray), true))
      rest = std::max(rest, walk(cluster_, path, gate, path.used, start, true, true).back() - start);
    return {spans + rest};
  }

  // Returns the longest time between two measurements of a sensor, in global time.
  Duration longest_between(SensorId id) const {
    const model::Sensor& sensor = cluster_.sensor(id);
    const Duration period = sensor.longest_period();
    return period + Duration{sensor.scheduled ? 0 : clocks_.drift_ns(period.ns)};
  }

  // The next measurement is first used at most one period and the bound of a first use after this one. The use
  // before that, one use period earlier, is the last with this measurement as the newest.
  Duration until_next_newest(const Path& path, SensorId id) const {
    const std::int64_t between_uses =
        path.use.repetition > 0 ? cluster_.cycle().ns * path.use.repetition - clocks_.apart_ns : 0;
    return {std::max<std::int64_t>(0, longest_between(id).ns - between_uses)};
  }

  // Returns the extreme walks behind 0, 1, ... and `last` stages.
  std::vector<Extreme> extremes(const Path& path, const model::Sensor& sensor, std::size_t last, bool latest) const {
    std::vector<Extreme> found(last + 1);
    // Before the first stage on the grid, all stages of a free-running sensor are spans.
    std::size_t gate = 0;
    if (!sensor.scheduled)
      for (; gate < last && !path.stages[gate].on_grid(latest); ++gate) {
        const Stage& stage = path.stages[gate];
        found[gate + 1] = found[gate];
        found[gate + 1].shares.push_back(latest                              ? stage.worst.ns
                                         : stage.kind == Stage::Kind::kSlots ? stage.shortest.ns
                                                                             : stage.best.ns);
        found[gate + 1].sum += found[gate + 1].shares.back();
      }
    if (gate == last) return found;
    std::vector<std::int64_t> starts;
    if (sensor.scheduled) {
      const std::int64_t from = first_analysed(cluster_.flexray);
      for (std::int64_t cycle = from; cycle < from + cycles_per_round(cluster_.flexray); ++cycle)
        if (in_cycle(sensor.at, cycle)) starts.push_back(time_of(cluster_.flexray, cycle, sensor.at.offset).ns);
    } else {
      starts = entries(cluster_, path.stages[gate], first_analysed(cluster_.flexray), latest);
    }
    const Extreme before = found[gate];
    for (const std::int64_t start : starts) {
      const std::vector<std::int64_t> instants = walk(cluster_, path, gate, last, start, latest, !sensor.scheduled);
      for (std::size_t i = 0; i < instants.size(); ++i) {
        Extreme& extreme = found[gate + i + 1];
        const std::int64_t on_grid = instants[i] - start, sum = before.sum + on_grid;
        if (!extreme.shares.empty() && (latest ? sum <= extreme.sum : sum >= extreme.sum)) continue;
        extreme = {before.shares, sum, on_grid};
        for (std::size_t k = 0; k <= i; ++k) extreme.shares.push_back(instants[k] - (k == 0 ? start : instants[k - 1]));
      }
    }
    return found;
  }

  // Spans before the grid already include their drift against any clock.
  std::int64_t clocks_low(const Extreme& low) const {
    return std::min(low.sum, clocks_.apart_ns + clocks_.drift_ns(low.on_grid));
  }
  std::int64_t clocks_high(const Extreme& high) const { return clocks_.apart_ns + clocks_.drift_ns(high.on_grid); }

  // Bounds of the age behind each number of stages.
  struct Bounds {
    std::vector<Extreme> low, high;
  };
  void bounds(const Bounds& all, std::size_t stages, Duration& best, Duration& worst) const {
    best = {all.low[stages].sum - clocks_low(all.low[stages])};
    worst = {all.high[stages].sum + clocks_high(all.high[stages])};
  }
  std::vector<Contribution> contributions(const Path& path, const Bounds& all, std::size_t stages) const {
    std::vector<Contribution> parts;
    for (std::size_t i = 0; i < stages; ++i)
      parts.push_back({path.stages[i].name, {all.low[stages].shares[i]}, {all.high[stages].shares[i]}});
    parts.push_back({"clocks differ", {-clocks_low(all.low[stages])}, {clocks_high(all.high[stages])}});
    return parts;
  }

  const model::Cluster& cluster_;
  ClockBounds clocks_;
};

}  // namespace

std::vector<AgePath> measurement_ages(const model::Cluster& cluster) {
  Ages ages(cluster);
  std::vector<AgePath> paths;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (const auto id = static_cast<SensorId>(s); ages.observes(id))
      if (auto path = ages.of(id)) paths.push_back(std::move(*path));
  std::vector<Ages::Release> releases;
  for (const AgePath& path : paths) ages.releases(path.sensor, releases);
  const Duration held = ages.held_for_arrivals(paths);
  for (AgePath& path : paths) {
    ages.buffer(path, path_of(cluster, path.sensor), releases, held);
    bool fused = false;
    for (Waypoint& point : path.waypoints) {
      fused = fused || point.kind == Waypoint::Kind::kFused;
      if (!fused) point.buffered_worst = point.worst;
      if (point.kind == Waypoint::Kind::kFused) point.buffered_worst = path.buffered_fused_worst;
      if (point.kind == Waypoint::Kind::kUsed) point.buffered_worst = path.buffered_use_worst;
    }
  }
  return paths;
}

std::vector<AgePath> ages_along(const model::Cluster& cluster, const std::vector<Path>& paths) {
  Ages ages(cluster);
  std::vector<AgePath> observed;
  std::vector<Ages::Release> releases;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (const auto id = static_cast<SensorId>(s); ages.observes(id))
      if (auto path = ages.of(id)) {
        ages.releases(id, releases);
        observed.push_back(std::move(*path));
      }
  const Duration held = ages.held_for_arrivals(observed);
  std::vector<AgePath> all;
  for (const Path& path : paths) {
    all.push_back(ages.of(path));
    if (path.held) ages.buffer(all.back(), path, releases, held);
  }
  return all;
}

std::vector<AgePath> odometry_ages(const model::Cluster& cluster) {
  Ages ages(cluster);
  std::vector<AgePath> paths;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (const auto id = static_cast<SensorId>(s); !ages.observes(id))
      if (auto path = ages.of(id)) paths.push_back(std::move(*path));
  return paths;
}

std::string ages_text(const model::Cluster& cluster) {
  const std::vector<AgePath> paths = measurement_ages(cluster), odometry = odometry_ages(cluster);
  if (paths.empty() && odometry.empty()) return "";
  std::string text = fmt::format("{:<52}{:>10}{:>10}\n", "age of a measurement [ms]", "best", "worst");
  const auto row = [&](const std::string& name, Duration best, Duration worst) {
    text += fmt::format("{:<52}{:>10.3f}{:>10.3f}\n", name, in_ms(best), in_ms(worst));
  };
  const auto bound = [&](const std::string& name, Duration worst) {
    text += fmt::format("{:<52}{:>10}{:>10.3f}\n", name, "", in_ms(worst));
  };
  for (const AgePath& path : paths) {
    text += fmt::format("{}\n", cluster.sensor(path.sensor).name);
    for (const Contribution& part : path.reaches_use ? path.to_use : path.to_fusion)
      row("    " + part.name, part.best, part.worst);
    row("  available to the fusion", path.fusion_best, path.fusion_worst);
    row("  fused", path.fused_best, path.fused_worst);
    if (path.reaches_use) row("  used first", path.use_best, path.use_worst);
    if (path.reaches_use && !path.chosen) bound("  newest one at any use", path.newest_worst);
    bound("  fused, if held for order (BUFF)", path.buffered_fused_worst);
    if (path.reaches_use) bound("  used first, if held for order (BUFF)", path.buffered_use_worst);
    if (path.reaches_use && !path.chosen) bound("  newest one at any use, if held (BUFF)", path.buffered_newest_worst);
  }
  for (const AgePath& path : odometry) {
    text += fmt::format("{}\n", cluster.sensor(path.sensor).name);
    for (const Contribution& part : path.to_fusion) row("    " + part.name, part.best, part.worst);
    row("  available", path.fusion_best, path.fusion_worst);
    row("  read; it is not held for order", path.fused_best, path.fused_worst);
  }
  return text;
}

}  // namespace ttf::schedules::analysis
