#include "fusion/estimators/make.h"
#include "fusion/motion/ctra.h"

namespace ttf::fusion::estimators {
namespace {

using motion::Ctra;
using motion::Ctrv;
template <class F>
using CtrvUnder = Single<F, Ctrv>;
template <class F>
using CtraUnder = Single<F, Ctra>;

}  // namespace

std::shared_ptr<const Estimator> make_turning(const TrackerConfig& config) {
  if (config.motion == MotionModel::kCtra)
    return under_the_filter<CtraUnder>(
        config, [&]<class F>() { return single<F>(config, Ctra(config.turn_noise, config.process_noise)); });
  return under_the_filter<CtrvUnder>(
      config, [&]<class F>() { return single<F>(config, Ctrv(config.turn_noise, config.process_noise)); });
}

}  // namespace ttf::fusion::estimators
