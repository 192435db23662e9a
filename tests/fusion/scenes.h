// Small scenes and oracles that the tests of fusion/ share.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "fusion/estimators/estimator.h"
#include "fusion/strategies/strategy.h"
#include "fusion/tracks/tracker.h"

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

// What a test varies of the default configuration.
TrackerConfig config_of(MotionModel motion, double process_noise = 3.0, FilterKind filter = FilterKind::kExtended);

// An estimate of a constant-velocity or constant-acceleration estimator, and what it is seen as; of tracks, under the
// default configuration.
Estimate estimate_of(MotionModel motion, const State& x, const Covariance& p);
Cartesian seen_as(const Estimate& estimate);
inline State state_of(const Track& track) { return seen_as(track.estimate).x; }

// view_of() with the configuration's own estimator.
TrackView shown(const Track& track, GlobalTime time, GlobalTime at, const TrackerConfig& config = {});

// F(dt) over the whole state, and the covariance of the driving noise over dt, by numerical integration of
// F(t) G q G' F(t)' with Gauss-Legendre nodes (exact for these polynomials): independent of the filter's
// formulas.
Covariance transition(MotionModel motion, double dt);
Covariance driving_noise(MotionModel motion, double q, double dt);

// A draw from N(mean, covariance), covariance positive semi-definite.
State draw(const State& mean, const Covariance& covariance, RandomStream& stream);

// Estimates, the states of two sets of tracks, images are the same to the last bit. Sets: whatever their tracks
// are called.
bool same_bits(const Estimate& a, const Estimate& b);
bool same_bits(const TrackSet& a, const TrackSet& b);
bool same_bits(const std::vector<TrackView>& a, const std::vector<TrackView>& b);

// Objects on a grid of lanes that drive at their own constant velocity, seen with noise and in shuffled order
// by one of two sensors in turn. A pure function of its arguments.
struct Lanes {
  int objects = 25;
  int across = 5;  // lanes
  double sigma = 0.2;
  double miss_probability = 0.0;
  std::uint64_t seed = 1;

  State truth(int object, GlobalTime at) const;
  std::vector<Observation> see(GlobalTime at, std::uint32_t index) const;
};

}  // namespace ttf::fusion
