// A car ahead drives away at 5 m/s. Two sensors see it every 40 ms. The second one's lists come 30 ms late, and ADVA takes
// them in as if all had come in order.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "core/time.h"
#include "fusion/strategies/strategy.h"

namespace strategies = ttf::fusion::strategies;
using ttf::Duration, ttf::GlobalTime, ttf::SensorId;

constexpr GlobalTime at_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

int main() {
  const auto late = strategies::Settling::after(Duration::milliseconds(40));
  const std::vector<strategies::SensorTiming> sensors{{SensorId{0}, late}, {SensorId{1}, late}};
  const auto strategy = strategies::make_strategy(strategies::StrategyKind::kAdva, {}, sensors);
  const auto see = [&](std::uint8_t sensor, std::uint32_t k, std::int64_t ms) {
    std::vector<ttf::fusion::sensors::Observation> seen(1);
    const double wobble = 0.1 * static_cast<double>((7 * k + 3 * sensor) % 5);  // [m], in place of a sensor's noise
    seen[0].z.head<2>() << 30.0 + 0.005 * static_cast<double>(ms) + wobble, 0.5 - wobble;
    seen[0].r.diagonal() << 0.04, 0.09, 0.0;
    strategy->accept({{SensorId{sensor}, k}, at_ms(ms), seen});
  };
  for (std::uint32_t k = 1; k <= 20; ++k) {
    const std::int64_t now = 40 * k;
    see(0, k, now);
    if (k > 1) see(1, k, now - 30);
    strategy->fuse(at_ms(now));
    for (const auto& track : strategy->tracks())
      std::printf("%4d ms: x %.17g m, y %.17g m, %.17g m/s, sigma of x^2 %.17g\n", static_cast<int>(now),
                  track.state(0), track.state(1), track.speed, track.covariance(0, 0));
  }
  return strategy->confirmed_count() == 1 ? 0 : 1;
}
