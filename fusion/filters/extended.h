// The extended Kalman filter linearises the models at the estimate, to first order (Bar-Shalom, Li, Kirubarajan
// 2001, 10.3). With linear models it is the Kalman filter.
#pragma once

#include "fusion/filters/kalman.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

struct Extended {
  static constexpr const char* kName = "Extended";

  template <motion::Model M> void predict(const M& model, linear::Gaussian<M::kStates>& state, double dt) const {
    if constexpr (M::kLinear) {
      Kalman{}.predict(model, state, dt);
    } else {
      const linear::Matrix<M::kStates> f = model.jacobian(state.x, dt);
      state.p = motion::sandwich<M::kStates, M::kStates>(f, state.p) + model.noise(state.x, dt);
      state.x = model.move(state.x, dt);
    }
  }

  template <motion::Model M, sensors::Model S>
  Innovation<S::kDimension> innovate(const M&, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                     const linear::Gaussian<M::kStates>& state) const {
    const motion::Kinematics k = M::template kinematics<S::kParts>(state.x);
    if (!sensor.sees(k)) return {};
    const linear::Vector<S::kDimension> nu = sensor.residual(z.z, sensor.expected(k));
    return filters::innovate<sensors::Direct<S>>(state, nu, measurement_matrix<M>(sensor, k, state.x), z.r);
  }

  template <motion::Model M, sensors::Model S>
  Innovation<S::kDimension> update(const M&, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                   linear::Gaussian<M::kStates>& state) const {
    const motion::Kinematics k = M::template kinematics<S::kParts>(state.x);
    if (!sensor.sees(k)) return {};
    const linear::Vector<S::kDimension> nu = sensor.residual(z.z, sensor.expected(k));
    const Innovation<S::kDimension> innovation =
        correct<sensors::Direct<S>>(state, nu, measurement_matrix<M>(sensor, k, state.x), z.r);
    M::normalise(state.x);
    return innovation;
  }
};

}  // namespace ttf::fusion::filters
