#include "tests/fusion/crossing.h"

#include <algorithm>
#include <cmath>

#include "fusion/metrics/clear_mot.h"
#include "fusion/metrics/consistency.h"
#include "fusion/metrics/set_distance.h"
#include "fusion/tracks/timeline.h"

namespace ttf::fusion {
namespace {

constexpr int kLists = 60, kJudgedFrom = 15;
constexpr double kPeriod = 0.1, kSigma = 0.3;
constexpr double kWidth = 60.0, kHeight = 20.0;

}  // namespace

Crossing::Drive Crossing::draw_drive(std::uint64_t seed) const {
  RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 5});
  const estimators::Covariance f = transition(config::MotionModel::kConstantVelocity, kPeriod);
  const estimators::Covariance q = driving_noise(config::MotionModel::kConstantVelocity, process_noise, kPeriod);
  std::vector<estimators::State> now(2, estimators::State::Zero());
  for (int object = 0; object < 2; ++object) {
    const double side = object == 0 ? 1.0 : -1.0;
    estimators::State& x = now[static_cast<std::size_t>(object)];
    x(0) = 5.0;
    x(1) = 4.0 * side;
    x(2) = 8.0;
    x(3) = -4.0 / 3.0 * side;
  }
  Drive drive;
  for (int k = 0; k < kLists; ++k) {
    std::vector<sensors::Observation> list;
    for (estimators::State& x : now) {
      if (k > 0) x = draw(f * x, q, stream);
      const bool seen = stream.uniform() < detection_probability;
      const double dx = kSigma * stream.normal(), dy = kSigma * stream.normal();
      if (seen) list.push_back(position(x(0) + dx, x(1) + dy, kSigma));
    }
    // The number of false ones is Poisson's: waiting times until their sum is over.
    for (double sum = -std::log(1.0 - stream.uniform()); sum < clutter_density * kWidth * kHeight;
         sum -= std::log(1.0 - stream.uniform()))
      list.push_back(position(stream.uniform(0.0, kWidth), stream.uniform(-0.5 * kHeight, 0.5 * kHeight), kSigma));
    drive.truth.push_back(now);
    drive.lists.push_back(list_of(0, static_cast<std::uint32_t>(k), at_ms(100 * k), std::move(list)));
  }
  return drive;
}

config::TrackerConfig Crossing::config() const {
  config::TrackerConfig config;
  config.process_noise = process_noise;
  config.detection_probability = detection_probability;
  config.clutter_density = clutter_density;
  config.end_overlaps = false;  // they pass through each other
  return config;
}

Followed follow(const Crossing& crossing, const config::TrackerConfig& config, int runs) {
  Followed sum;
  std::uint64_t judged = 0, pairs = 0;
  for (int run = 1; run <= runs; ++run) {
    const Crossing::Drive drive = crossing.draw_drive(static_cast<std::uint64_t>(run));
    tracks::Timeline timeline(config, 96);
    metrics::ClearMot mot(3.0);
    metrics::SetMetric distance({.distance_m = 5.0, .order = 2.0});
    const auto estimator = estimators::make_estimator(config);
    for (std::size_t k = 0; k < drive.lists.size(); ++k) {
      timeline.insert(drive.lists[k].view());
      std::vector<metrics::Point> truths, estimates;
      std::vector<metrics::Named> objects, tracks;
      std::vector<estimators::Cartesian> states;
      for (const estimators::State& x : drive.truth[k]) {
        objects.push_back({static_cast<metrics::Identity>(objects.size()), {x(0), x(1)}});
        truths.push_back({x(0), x(1)});
      }
      for (const tracks::Track& track : timeline.current().tracks) {
        if (!track.confirmed) continue;
        states.push_back(estimator->cartesian(track.estimate));
        estimates.push_back({states.back().x(0), states.back().x(1)});
        tracks.push_back({static_cast<metrics::Identity>(index_of(track.id)), estimates.back()});
      }
      if (k < static_cast<std::size_t>(kJudgedFrom)) continue;
      mot.step(objects, tracks);
      ++judged;
      sum.gospa += distance.between(truths, estimates).gospa.distance_m;
      for (std::size_t i = 0; i < truths.size(); ++i) {
        const int estimate = distance.estimate_of()[i];
        if (estimate < 0) continue;
        const estimators::Cartesian& state = states[static_cast<std::size_t>(estimate)];
        sum.nees += metrics::nees<4>({state.x.head<4>(), state.p.topLeftCorner<4, 4>()},
                                     linear::Vector<4>(drive.truth[k][i].head<4>()));
        ++pairs;
      }
    }
    sum.switches += mot.counts().switches;
    sum.misses += mot.counts().misses;
    sum.false_tracks += mot.counts().false_positives;
  }
  sum.nees /= static_cast<double>(pairs);
  sum.gospa /= static_cast<double>(judged);
  return sum;
}

}  // namespace ttf::fusion
