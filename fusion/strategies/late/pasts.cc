#include "fusion/strategies/late/pasts.h"

#include "core/check.h"

namespace ttf::fusion::late {

std::unique_ptr<Pasts> make_pasts(const TrackerConfig& config, std::size_t slots) {
  switch (config.motion) {
    case MotionModel::kConstantVelocity: return make_at_constant_velocity(config, slots);
    case MotionModel::kConstantAcceleration: return make_at_constant_acceleration(config, slots);
    case MotionModel::kCtrv:
    case MotionModel::kCtra:
    case MotionModel::kInteracting: break;
  }
  TTF_CHECK(false, "no past of motion model {}", static_cast<int>(config.motion));
}

}  // namespace ttf::fusion::late
