#include "schedules/analysis/settled.h"

#include <algorithm>
#include <numeric>

#include "schedules/analysis/age_stages.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

// Stamps are rounded to the nearest microsecond.
constexpr std::int64_t kStampRounding_ns = 500;

}  // namespace

std::optional<SettledRound> settled_round(const model::Cluster& cluster, SensorId sensor) {
  const Path path = path_of(cluster, sensor);
  const std::size_t fusing = path.available;
  if (fusing >= path.stages.size() || path.stages[fusing].kind != Stage::Kind::kActivation) return std::nullopt;
  // The time from the stamp to the entry at the gate, the first stage on the grid.
  std::int64_t before =
      clock_bounds(cluster).apart_ns + (cluster.flexray.gdMacrotick_ps + 999) / 1000 + kStampRounding_ns;
  std::size_t gate = 0;
  for (; !path.stages[gate].on_grid(true); ++gate) before += path.stages[gate].worst.ns;

  const std::int64_t cycles = cycles_per_round(cluster.flexray), from = first_analysed(cluster.flexray);
  const std::int64_t round_ps = cycles * cluster.flexray.cycle_ps();
  const std::int64_t rounds = 1000 / std::gcd<std::int64_t>(1000, round_ps);
  std::vector<std::int64_t> gates;
  for (std::int64_t r = 0; r < rounds; ++r)
    for (const std::int64_t missed : entries(cluster, path.stages[gate], from + r * cycles, true))
      gates.push_back(missed - 1);
  std::sort(gates.begin(), gates.end());

  SettledRound result;
  result.round = {round_ps * rounds / 1000};
  for (const std::int64_t entered : gates) {
    const GlobalTime at{walk(cluster, path, gate, fusing + 1, entered, true, true).back()};
    const GlobalTime measured{entered - before};
    // Entries are in order: the last of several read at one instant settles the most.
    if (!result.instants.empty() && result.instants.back().at == at)
      result.instants.back().measured = measured;
    else
      result.instants.push_back({at, measured});
  }
  // The first instant of the next round settles more at the same time.
  if (result.instants.back().at == result.instants.front().at + result.round) result.instants.pop_back();
  return result;
}

}  // namespace ttf::schedules::analysis
