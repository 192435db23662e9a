#include "bus/wire/symbols.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ttf::bus::wire {
namespace {

Duration bits(const schedules::model::GlobalParameters& flexray, int count) {
  return {count * flexray.gdBit_ps / 1000};
}

// Returns the low phases of all patterns, without overlap, in the order of time.
std::vector<WakeupPattern> low_phases(const schedules::model::GlobalParameters& flexray,
                                      std::span<const WakeupPattern> patterns) {
  const Duration low = bits(flexray, flexray.gdWakeupSymbolTxLow);
  const Duration symbol = low + bits(flexray, flexray.gdWakeupSymbolTxIdle);
  std::vector<WakeupPattern> phases;
  for (const WakeupPattern& pattern : patterns) {
    // A sender's clock is a little off, so its symbols are a little shorter or longer.
    const Duration whole = pattern.to - pattern.from;
    const std::int64_t symbols = (whole.ns + symbol.ns / 2) / symbol.ns;
    for (std::int64_t s = 0; s < symbols; ++s) {
      const Duration from = pattern.from + Duration{whole.ns * s / symbols};
      phases.push_back({from, from + Duration{whole.ns * low.ns / (symbols * symbol.ns)}});
    }
  }
  std::sort(phases.begin(), phases.end(),
            [](const WakeupPattern& a, const WakeupPattern& b) { return a.from < b.from; });
  std::vector<WakeupPattern> joined;
  for (const WakeupPattern& phase : phases) {
    if (joined.empty() || phase.from > joined.back().to)
      joined.push_back(phase);
    else
      joined.back().to = std::max(joined.back().to, phase.to);
  }
  return joined;
}

}  // namespace

bool wakes(const schedules::model::GlobalParameters& flexray, std::span<const WakeupPattern> patterns) {
  const std::vector<WakeupPattern> low = low_phases(flexray, patterns);
  const Duration long_enough = bits(flexray, flexray.gdWakeupSymbolRxLow);
  const Duration idle = bits(flexray, flexray.gdWakeupSymbolRxIdle);
  const Duration window = bits(flexray, flexray.gdWakeupSymbolRxWindow);
  for (std::size_t i = 0; i + 1 < low.size(); ++i)
    if (low[i].to - low[i].from >= long_enough && low[i + 1].from - low[i].to >= idle &&
        low[i + 1].to - low[i + 1].from >= long_enough && low[i + 1].from + long_enough - low[i].from <= window)
      return true;
  return false;
}

bool wakes(const schedules::model::GlobalParameters& flexray) {
  const std::array alone{
      WakeupPattern{Duration{}, bits(flexray, 2 * (flexray.gdWakeupSymbolTxLow + flexray.gdWakeupSymbolTxIdle))}};
  return wakes(flexray, alone);
}

}  // namespace ttf::bus::wire
