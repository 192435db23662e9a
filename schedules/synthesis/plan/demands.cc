#include "schedules/synthesis/plan/demands.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/decimal.h"
#include "core/strict_yaml.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::plan {
namespace {

constexpr Range<double> kDensities{1e-6, 1e6};
constexpr Range<double> kSigmas{1e-4, 1e3};  // [m]

// Odometry measures its own vehicle.
bool observes(const Plan& plan, const PlannedChain& chain) {
  return model::row_of(plan.cluster.sensor(chain.from).kind).observes;
}

std::vector<double> read_densities(YamlMap& map) {
  if (!map.has("process_noises")) return {map.number("process_noise", kDensities)};
  if (map.has("process_noise")) map.fail("process_noise", "must be left out: process_noises has the densities");
  std::vector<double> densities;
  for (const std::string& text : map.texts("process_noises")) {
    constexpr double kScale = 1e9;
    const auto scaled = parse_scaled(text, static_cast<std::int64_t>(kScale));
    const double density = scaled ? static_cast<double>(*scaled) / kScale : 0.0;
    if (kDensities.contains(density))
      densities.push_back(density);
    else
      map.fail("process_noises",
               fmt::format("must be numbers of {} to {}, not {}", kDensities.low, kDensities.high, text));
  }
  return densities;
}

void read_sigmas(YamlMap& map, const Plan& plan, ErrorDemand& demand) {
  demand.sigmas_m.resize(plan.sensors.size());
  YamlMap sigmas = map.map("sigma");
  for (std::size_t s = 0; s < plan.sensors.size(); ++s)
    if (const std::string& name = plan.cluster.sensors[s].name; sigmas.has(name))
      demand.sigmas_m[s] = sigmas.number(name, kSigmas, "m");
  for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
    if (demand.sigmas_m[s] || !plan.sensors[s].like) continue;
    const SensorId like = *plan.sensors[s].like;
    if (plan.cluster.sensors[s].kind == plan.cluster.sensor(like).kind)
      demand.sigmas_m[s] = demand.sigmas_m[index_of(like)];
  }
  for (const PlannedChain& chain : plan.chains)
    if (observes(plan, chain) && !demand.sigmas_m[index_of(chain.from)]) {
      const std::string& name = plan.cluster.sensor(chain.from).name;
      sigmas.fail(name, fmt::format("is missing: {} begins the chain {}", name, chain.name));
    }
  sigmas.finish();
}

void read_error(YamlMap& map, Plan& plan) {
  ErrorDemand demand;
  demand.random_walk =
      map.choice_or("motion", false, Choices<bool>{{"constant_velocity", false}, {"random_walk", true}});
  demand.over_time = map.choice_or("over", false, Choices<bool>{{"uses", false}, {"time", true}});
  demand.process_noises = read_densities(map);
  read_sigmas(map, plan, demand);
  map.finish();
  plan.error = std::move(demand);
}

void read_gap_error(YamlMap& map, GapErrorDemand& demand) {
  const auto seconds = [&](const char* key, double otherwise, Range<Duration> allowed) {
    return map.duration_or(key, {static_cast<std::int64_t>(otherwise * 1e9)}, allowed).seconds();
  };
  demand.time_gap_s =
      seconds("time_gap", demand.time_gap_s, {Duration::milliseconds(100), Duration::milliseconds(10'000)});
  demand.lag_s = seconds("lag", demand.lag_s, {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  demand.memory_s =
      seconds("memory", demand.memory_s, {Duration::milliseconds(100), Duration::milliseconds(1'000'000)});
  demand.density = map.number_or("density", demand.density, kDensities, "m^2/s^3");
  demand.delay = map.duration_or("delay", demand.delay, {Duration{}, Duration::milliseconds(10'000)});
  map.finish();
}

}  // namespace

void read_demands(YamlMap& section, Plan& plan) {
  if (auto map = section.map_if("error")) read_error(*map, plan);
  if (auto map = section.map_if("gap_error")) read_gap_error(*map, plan.gap_error);
  const auto asked = [&](Goal goal) {
    return std::find(plan.objective.begin(), plan.objective.end(), goal) != plan.objective.end();
  };
  if (asked(Goal::kError) && !section.has("error"))
    section.fail("error", "must have process_noise and sigma: the objective error counts with them");
  const bool observed = std::any_of(plan.chains.begin(), plan.chains.end(),
                                    [&](const PlannedChain& chain) { return observes(plan, chain); });
  if ((asked(Goal::kError) || asked(Goal::kGapError)) && !observed)
    section.fail("objective", "must leave out error and gap_error: no chain begins with a sensor of objects");
}

}  // namespace ttf::schedules::synthesis::plan
