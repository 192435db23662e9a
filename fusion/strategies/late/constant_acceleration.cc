#include "fusion/motion/constant_acceleration.h"

#include "fusion/strategies/late/pasts_of.h"

namespace ttf::fusion::strategies::late {

std::unique_ptr<Pasts> make_at_constant_acceleration(const config::TrackerConfig& config, std::size_t slots) {
  motion::ConstantAcceleration model(config.process_noise, config.noise_across());
  model.drift_density = config.drift_density();
  return make_pasts_of<2>(model, config, slots);
}

}  // namespace ttf::fusion::strategies::late
