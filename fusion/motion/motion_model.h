// What a motion model is. A new one is a small header that derives from a layout (layout.h) and says, with dt >= 0 in
// seconds and x the state:
//   move(x, dt)      where x is after dt;
//   jacobian(x, dt)  d move / d x;
//   noise(x, dt)     covariance of what white noise adds in dt to what starts at x, symmetric positive semi-definite.
// Laws, tested over every model: moving by dt in one step or in two is the same to rounding; jacobian is the
// derivative; noise is the integral of the driving noise along the way of x, to first order of that noise.
// A linear model says its step besides; what is a chain of integrators in both axes (integrator_chain.h) moves
// covariances at a fraction of the cost of the matrix product.
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

// Adds a step to state and covariance in place; the same as step(dt), but for rounding.
template <class M>
concept StructuredModel = LinearModel<M> && requires(const M& model, linear::Gaussian<M::kStates>& state, double dt) {
  {model.advance(state, dt)};
};

}  // namespace ttf::fusion::motion
