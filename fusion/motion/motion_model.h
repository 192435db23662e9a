// A motion model is a small header that derives from a layout (layout.h). With dt >= 0 in seconds and the state
// x it has:
//   move(x, dt)      the state after dt;
//   jacobian(x, dt)  d move / d x;
//   noise(x, dt)     the covariance that white noise adds within dt from x on, symmetric positive semi-definite.
// Tests hold every model to three laws. One transition by dt equals two shorter ones, up to rounding. The
// jacobian is the derivative. The noise is the integral of the driving noise along the path of x, to first
// order of that noise. A linear model also has step(dt). A chain of integrators (integrator_chain.h) also moves
// covariances, at a fraction of the matrix product's cost.
#pragma once

#include <concepts>

#include "fusion/motion/layout.h"

namespace ttf::fusion::motion {

template <class M>
concept Model = requires(const M& model, const linear::Vector<M::kStates>& x, linear::Vector<M::kStates>& changed,
                         double dt) {
  requires M::kStates >= 4;
  { M::kCartesian } -> std::convertible_to<bool>;
  { M::kLinear } -> std::convertible_to<bool>;
  { model.move(x, dt) } -> std::same_as<linear::Vector<M::kStates>>;
  { model.jacobian(x, dt) } -> std::same_as<linear::Matrix<M::kStates>>;
  { model.noise(x, dt) } -> std::same_as<linear::Matrix<M::kStates>>;
  { M::difference(x, x) } -> std::same_as<linear::Vector<M::kStates>>;
  {M::normalise(changed)};
  { M::template kinematics<kWithHeading>(x) } -> std::same_as<Kinematics>;
  { M::kinematics_jacobian(x) } -> std::same_as<linear::Matrix<5, 4>>;
};

template <class M>
concept LinearModel = Model<M> && M::kLinear && requires(const M& model, double dt) {
  { model.step(dt) } -> std::same_as<linear::LinearStep<M::kStates>>;
};

// A structured model also adds a transition to state and covariance in place; it equals step(dt) up to
// rounding.
template <class M>
concept StructuredModel = LinearModel<M> && requires(const M& model, linear::Gaussian<M::kStates>& state, double dt) {
  {model.advance(state, dt)};
};

}  // namespace ttf::fusion::motion
