// Small scenes and oracles that the tests of fusion/ share.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/random.h"
#include "fusion/estimators/estimator.h"
#include "fusion/strategies/strategy.h"
#include "fusion/tracks/tracker.h"
#include "fusion/tracks/view.h"

namespace ttf::fusion {

inline constexpr double kPi = std::numbers::pi;
constexpr GlobalTime at_ms(std::int64_t ms) { return GlobalTime{ms * 1'000'000}; }

sensors::Observation position(double x, double y, double sigma);
sensors::Observation radar(double range, double bearing, double rate, double sigma_range, double sigma_bearing,
                           double sigma_rate);

// A list that owns its observations.
struct OwnedList {
  MeasurementId id;
  GlobalTime measured{};
  std::vector<sensors::Observation> observations;
  sensors::ObservationList view() const { return {id, measured, observations}; }
};
inline OwnedList list_of(std::uint8_t sensor, std::uint32_t sequence, GlobalTime measured,
                         std::vector<sensors::Observation> observations = {}) {
  return {{static_cast<SensorId>(sensor), sequence}, measured, std::move(observations)};
}

// A tracker that is fed list by list.
struct Bench {
  config::TrackerConfig config;
  tracks::Tracker tracker;
  tracks::TrackSet set;
  std::uint32_t sequence = 0;

  explicit Bench(const config::TrackerConfig& c = {}) : config(c), tracker(c, 64), set(tracker.max_tracks()) {}
  void step(std::int64_t ms, std::vector<sensors::Observation> observations) {
    tracker.step(set, list_of(0, sequence++, at_ms(ms), std::move(observations)).view());
  }
};
int confirmed(const tracks::TrackSet& set);

// The default configuration with a test's variations.
config::TrackerConfig config_of(config::MotionModel motion, double process_noise = 3.0,
                                config::FilterKind filter = config::FilterKind::kExtended);

// An estimate of a constant-velocity or constant-acceleration estimator, and its observation; of tracks,
// under the default configuration.
estimators::Estimate estimate_of(config::MotionModel motion, const estimators::State& x,
                                 const estimators::Covariance& p);
estimators::Cartesian seen_as(const estimators::Estimate& estimate);
inline estimators::State state_of(const tracks::Track& track) { return seen_as(track.estimate).x; }

// view_of() with the configuration's own estimator.
tracks::TrackView shown(const tracks::Track& track, GlobalTime time, GlobalTime at,
                        const config::TrackerConfig& config = {});

// F(dt) over the whole state, and the covariance of the driving noise over dt. The latter integrates F(t) G q
// G' F(t)' numerically with Gauss-Legendre nodes (exact for these polynomials), independently of the filter's
// formulas.
estimators::Covariance transition(config::MotionModel motion, double dt);
estimators::Covariance driving_noise(config::MotionModel motion, double q, double dt);

// A draw from N(mean, covariance), covariance positive semi-definite.
estimators::State draw(const estimators::State& mean, const estimators::Covariance& covariance, RandomStream& stream);

// Estimates, the states of two track sets, or images are bitwise equal. Track sets: regardless of names.
bool same_bits(const estimators::Estimate& a, const estimators::Estimate& b);
bool same_bits(const tracks::TrackSet& a, const tracks::TrackSet& b);
bool same_bits(const std::vector<tracks::TrackView>& a, const std::vector<tracks::TrackView>& b);

// Objects on a grid of lanes, each with its own constant velocity. Two sensors in turn see them with noise,
// in shuffled order. A pure function of its arguments.
struct Lanes {
  int objects = 25;
  int across = 5;  // lanes
  double sigma = 0.2;
  double miss_probability = 0.0;
  std::uint64_t seed = 1;

  estimators::State truth(int object, GlobalTime at) const;
  std::vector<sensors::Observation> see(GlobalTime at, std::uint32_t index) const;
};

}  // namespace ttf::fusion
