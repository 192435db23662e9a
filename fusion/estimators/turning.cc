#include "fusion/estimators/make.h"
#include "fusion/motion/ctra.h"

namespace ttf::fusion::estimators {

std::shared_ptr<const Estimator> make_turning(const config::TrackerConfig& config) {
  if (config.motion == config::MotionModel::kCtra)
    return make_single(config, motion::Ctra(config.turn_noise, config.process_noise));
  return make_single(config, motion::Ctrv(config.turn_noise, config.process_noise));
}

}  // namespace ttf::fusion::estimators
