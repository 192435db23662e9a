// Small scenes and oracles that the tests of fusion/ share.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "fusion/filter.h"
#include "fusion/strategy.h"
#include "fusion/tracker.h"

namespace ttf::fusion {

inline constexpr double kPi = std::numbers::pi;
constexpr GlobalTime at_ms(std::int64_t ms) { return GlobalTime{ms * 1'000'000}; }

Observation position(double x, double y, double sigma);
Observation radar(double range, double bearing, double rate, double sigma_range, double sigma_bearing,
                  double sigma_rate);

// A scan that owns its observations.
struct OwnedScan {
  MeasurementId id;
  GlobalTime measured{};
  std::vector<Observation> observations;
  Scan view() const { return {id, measured, observations}; }
};
inline OwnedScan scan(std::uint8_t sensor, std::uint32_t sequence, GlobalTime measured,
                      std::vector<Observation> observations = {}) {
  return {{static_cast<SensorId>(sensor), sequence}, measured, std::move(observations)};
}

// F(dt) over the whole state, and the covariance of the driving noise over dt, by numerical integration of
// F(t) G q G' F(t)' with Gauss-Legendre nodes (exact for these polynomials): independent of the filter's
// formulas.
Covariance transition(MotionModel motion, double dt);
Covariance driving_noise(MotionModel motion, double q, double dt);

// A draw from N(mean, covariance), covariance positive semi-definite.
State draw(const State& mean, const Covariance& covariance, RandomStream& stream);

// The states of two sets of tracks, images, reports are the same to the last bit. Sets: whatever their tracks
// are called.
bool same_bits(const TrackSet& a, const TrackSet& b);
bool same_bits(const std::vector<TrackView>& a, const std::vector<TrackView>& b);

// Objects on a grid of lanes that drive at their own constant velocity, seen with noise and in shuffled order
// by one of two sensors in turn. A pure function of its arguments.
struct Lanes {
  int objects = 25;
  double sigma = 0.2;
  double miss_probability = 0.0;
  std::uint64_t seed = 1;

  State truth(int object, GlobalTime at) const;
  std::vector<Observation> see(GlobalTime at, std::uint32_t index) const;
};

}  // namespace ttf::fusion
