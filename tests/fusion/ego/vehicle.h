// A vehicle that drives straight at 30 km/h and then turns left, for the tests of ego motion; with its odometry.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "fusion/ego/ego_path.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::ego {

// The true motion, integrated by Simpson's rule in steps of half a millisecond. The yaw rate grows within half a second.
class Vehicle {
 public:
  static constexpr double kSpeed = 30.0 / 3.6, kTurn = 0.4;  // [m/s], [rad/s]

  explicit Vehicle(double seconds) {
    constexpr double kStep = 5e-4;
    sensors::Mounting at;
    for (double t = 0.0; t <= seconds; t += kStep) {
      poses_.push_back(at);
      const auto direction = [&](double later) {
        const double heading = heading_at(t + later);
        return linear::Vector<2>(std::cos(heading), std::sin(heading));
      };
      at.position += kSpeed * kStep / 6.0 * (direction(0.0) + 4.0 * direction(0.5 * kStep) + direction(kStep));
    }
  }
  static double yaw_rate_at(double t) { return kTurn * std::min(1.0, std::max(0.0, t - 1.0) / 0.5); }
  static double heading_at(double t) {
    const double s = std::max(0.0, t - 1.0);
    return kTurn * (s < 0.5 ? s * s : s - 0.25);
  }
  // At multiples of half a millisecond.
  sensors::Mounting at(double t) const {
    sensors::Mounting vehicle = poses_.at(static_cast<std::size_t>(std::lround(t / 5e-4)));
    vehicle.yaw = heading_at(t);
    vehicle.yaw_rate = yaw_rate_at(t);
    vehicle.velocity = kSpeed * linear::Vector<2>(std::cos(vehicle.yaw), std::sin(vehicle.yaw));
    return vehicle;
  }
  linear::Vector<2> seen(const linear::Vector<2>& over_ground, double t) const {
    const sensors::Mounting vehicle = at(t);
    return sensors::turned(over_ground - vehicle.position, -vehicle.yaw);
  }

 private:
  std::vector<sensors::Mounting> poses_;
};

constexpr double seconds_of(std::int64_t ms) { return static_cast<double>(ms) * 1e-3; }

// The exact sample at an instant.
inline OdometrySample exact_sample(std::int64_t ms) {
  return {at_ms(ms), Vehicle::kSpeed, Vehicle::yaw_rate_at(seconds_of(ms))};
}

// Samples of one drive, every 20 ms, with noise and with constant errors drawn as `errors` says.
inline std::vector<OdometrySample> drawn_samples(const OdometryErrors& errors, std::int64_t until_ms,
                                                 RandomStream& draw) {
  const double scale = errors.speed_scale_sigma * draw.normal(), bias = errors.yaw_rate_bias_sigma * draw.normal();
  std::vector<OdometrySample> samples;
  for (std::int64_t ms = 0; ms <= until_ms; ms += 20) {
    OdometrySample sample = exact_sample(ms);
    sample.speed = (1.0 + scale) * sample.speed + errors.speed_sigma * draw.normal();
    sample.yaw_rate += bias + errors.yaw_rate_sigma * draw.normal();
    sample.speed_sigma = errors.speed_sigma;
    sample.yaw_rate_sigma = errors.yaw_rate_sigma;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace ttf::fusion::ego
