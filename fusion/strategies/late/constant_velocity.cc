#include "fusion/motion/constant_velocity.h"

#include "fusion/strategies/late/pasts_of.h"

namespace ttf::fusion::late {

std::unique_ptr<Pasts> make_at_constant_velocity(const TrackerConfig& config, std::size_t slots) {
  return make_pasts_of(motion::ConstantVelocity(config.process_noise), config.late, slots);
}

}  // namespace ttf::fusion::late
