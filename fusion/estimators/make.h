// Makes the estimators, one function and one source file for each kind of motion: these templates compile
// slowly.
#pragma once

#include <memory>

#include "fusion/estimators/estimator.h"
#include "fusion/estimators/model_estimator.h"
#include "fusion/filters/extended.h"
#include "fusion/filters/unscented.h"

namespace ttf::fusion::estimators {

std::shared_ptr<const Estimator> make_straight(const config::TrackerConfig& config);  // constant velocity, acceleration
std::shared_ptr<const Estimator> make_turning(const config::TrackerConfig& config);   // CTRV, CTRA
std::shared_ptr<const Estimator> make_interacting(const config::TrackerConfig& config);  // constant velocity and CTRV

// Constant velocity and acceleration under the extended filter; it considers the sensors' biases.
std::shared_ptr<const Estimator> make_considering(const config::TrackerConfig& config);

// Returns a ModelEstimator over the kernel make<F>() with the configured filter F.
template <class Make>
std::shared_ptr<const Estimator> under_the_filter(const config::TrackerConfig& config, const Make& make) {
  const auto under = [&]<class F>() -> std::shared_ptr<const Estimator> {
    auto kernel = make.template operator()<F>();
    return std::make_shared<ModelEstimator<F, decltype(kernel)>>(config, kernel);
  };
  return config.filter == config::FilterKind::kUnscented ? under.template operator()<filters::Unscented>()
                                                         : under.template operator()<filters::Extended>();
}

// Returns the prior of any road vehicle's turn rate, and of its acceleration per axis or along its heading.
template <motion::Model M> linear::Gaussian<M::kStates> prior_of(const config::TrackerConfig& config) {
  linear::Gaussian<M::kStates> prior;
  if constexpr (!M::kCartesian)
    prior.p(M::kTurnRate, M::kTurnRate) = config.initial_turn_rate_sigma * config.initial_turn_rate_sigma;
  if constexpr (M::kStates == 6)
    for (int i = M::kCartesian ? 4 : 5; i < 6; ++i)
      prior.p(i, i) = config.initial_acceleration_sigma * config.initial_acceleration_sigma;
  return prior;
}

template <class F, motion::Model M> Single<F, M> single(const config::TrackerConfig& config, M model) {
  model.drift_density = config.drift_density();
  return {.model = model, .prior = prior_of<M>(config), .filter = {}};
}

template <motion::Model M>
std::shared_ptr<const Estimator> make_single(const config::TrackerConfig& config, const M& model) {
  return under_the_filter(config, [&]<class F>() { return single<F>(config, model); });
}

}  // namespace ttf::fusion::estimators
