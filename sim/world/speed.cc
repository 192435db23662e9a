#include "sim/world/speed.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sim/world/world.h"

namespace ttf::sim::world {

Speed::Speed(const WorldConfig& config, double start, const ObjectKey& key, double step)
    : sigma_(config.acceleration_noise), step_(step), profile_(start) {
  if (config.speed_memory == Duration{} || sigma_ == 0.0) return;
  const double tau = config.speed_memory.seconds(), stationary = sigma_ * std::sqrt(0.5 * step * tau);
  kept_ = std::exp(-step / tau);
  forgetting_ = 1.0 / tau;
  spread_ = stationary * std::sqrt(-std::expm1(-2.0 * step / tau));
  RandomStream stream(
      {key.seed, key.replication, Purpose::kSpeedAtStart, static_cast<std::uint16_t>(index_of(key.object)), 0});
  deviation_ = stationary * stream.normal();
}

double Speed::at_start() const { return std::max(0.0, profile_ + deviation_); }

double Speed::acceleration(double profile, double noise, double speed) {
  if (spread_ == 0.0) return profile + sigma_ * noise;
  profile_ = std::max(0.0, profile_ + profile * step_);
  deviation_ = kept_ * deviation_ + spread_ * noise;
  return (profile_ + deviation_ - speed) / step_;
}

}  // namespace ttf::sim::world
