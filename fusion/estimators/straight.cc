#include "fusion/estimators/make.h"
#include "fusion/motion/constant_acceleration.h"

namespace ttf::fusion::estimators {

std::shared_ptr<const Estimator> make_straight(const config::TrackerConfig& config) {
  if (config.motion == config::MotionModel::kConstantAcceleration)
    return make_single(config, motion::ConstantAcceleration(config.process_noise, config.noise_across()));
  return make_single(config, motion::ConstantVelocity(config.process_noise, config.noise_across()));
}

}  // namespace ttf::fusion::estimators
