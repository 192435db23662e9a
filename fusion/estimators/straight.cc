#include "fusion/estimators/make.h"
#include "fusion/motion/constant_acceleration.h"

namespace ttf::fusion::estimators {
namespace {

using motion::ConstantAcceleration;
using motion::ConstantVelocity;
template <class F>
using VelocityUnder = Single<F, ConstantVelocity>;
template <class F>
using AccelerationUnder = Single<F, ConstantAcceleration>;

}  // namespace

std::shared_ptr<const Estimator> make_straight(const TrackerConfig& config) {
  if (config.motion == MotionModel::kConstantAcceleration)
    return under_the_filter<AccelerationUnder>(
        config, [&]<class F>() { return single<F>(config, ConstantAcceleration(config.process_noise)); });
  return under_the_filter<VelocityUnder>(
      config, [&]<class F>() { return single<F>(config, ConstantVelocity(config.process_noise)); });
}

}  // namespace ttf::fusion::estimators
