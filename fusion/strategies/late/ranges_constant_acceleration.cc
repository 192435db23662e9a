#include "fusion/motion/constant_acceleration.h"

#include "fusion/strategies/late/pasts_of.h"

namespace ttf::fusion::strategies::late {

std::unique_ptr<Pasts> make_with_ranges_at_constant_acceleration(const config::TrackerConfig& config,
                                                                 std::size_t slots) {
  return make_pasts_of<3>(motion::ConstantAcceleration(config.process_noise, config.noise_across()), config, slots);
}

}  // namespace ttf::fusion::strategies::late
