#include "fusion/estimators/interacting.h"

#include "fusion/estimators/make.h"

namespace ttf::fusion::estimators {

std::shared_ptr<const Estimator> make_interacting(const config::TrackerConfig& config) {
  return under_the_filter(config, [&]<class F>() {
    return StraightAndTurning<F>({.seconds = config.mode_seconds},
                                 single<F>(config, motion::ConstantVelocity(config.process_noise)),
                                 single<F>(config, motion::Ctrv(config.turn_noise, config.process_noise)));
  });
}

}  // namespace ttf::fusion::estimators
