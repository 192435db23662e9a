// The Kalman filter is exact for linear motion and linear measurements. Structured models move the covariance
// themselves (motion/integrator_chain.h); other models use the general matrix product.
#pragma once

#include "fusion/filters/correct.h"
#include "fusion/filters/linearise.h"

namespace ttf::fusion::filters {

struct Kalman {
  static constexpr const char* kName = "Kalman";

  template <motion::LinearModel M> void predict(const M& model, linear::Gaussian<M::kStates>& state, double dt) const {
    if constexpr (motion::StructuredModel<M>)
      model.advance(state, dt);
    else
      linear::predict<M::kStates>(state, model.step(dt));
  }

  template <motion::LinearModel M, sensors::Model S>
  requires(S::kLinear&& M::kCartesian) Innovation<S::kDimension> innovate(const M&, const S& sensor,
                                                                          const sensors::Measurement<S::kDimension>& z,
                                                                          const linear::Gaussian<M::kStates>& state)
  const {
    const motion::Kinematics k = M::template kinematics<S::kParts>(state.x);
    const linear::Vector<S::kDimension> nu = sensor.residual(z.z, sensor.expected(k));
    return filters::innovate<sensors::Direct<S>>(state, nu, measurement_matrix<M>(sensor, k, state.x), z.r);
  }

  template <motion::LinearModel M, sensors::Model S>
  requires(S::kLinear&& M::kCartesian) Innovation<S::kDimension> update(const M&, const S& sensor,
                                                                        const sensors::Measurement<S::kDimension>& z,
                                                                        linear::Gaussian<M::kStates>& state)
  const {
    const motion::Kinematics k = M::template kinematics<S::kParts>(state.x);
    const linear::Vector<S::kDimension> nu = sensor.residual(z.z, sensor.expected(k));
    return correct<sensors::Direct<S>>(state, nu, measurement_matrix<M>(sensor, k, state.x), z.r);
  }
};

}  // namespace ttf::fusion::filters
