#include "fusion/strategies/late/pasts.h"

#include "core/check.h"

namespace ttf::fusion::strategies::late {

std::unique_ptr<Pasts> make_pasts(const config::TrackerConfig& config, std::size_t slots, bool ranges) {
  switch (config.motion) {
    case config::MotionModel::kConstantVelocity:
      return (ranges ? make_with_ranges_at_constant_velocity : make_at_constant_velocity)(config, slots);
    case config::MotionModel::kConstantAcceleration:
      return (ranges ? make_with_ranges_at_constant_acceleration : make_at_constant_acceleration)(config, slots);
    case config::MotionModel::kCtrv:
    case config::MotionModel::kCtra:
    case config::MotionModel::kInteracting: break;
  }
  TTF_CHECK(false, "no past of motion model {}", static_cast<int>(config.motion));
}

}  // namespace ttf::fusion::strategies::late
