// A filter is a value without state: it predicts a normal distribution with a motion model and updates it with
// a sensor model. The filters are Kalman (linear models), Extended and Unscented. Imm (imm.h) combines several
// motion models, and Consider (consider.h) carries systematic errors without estimating them. For gates,
// innovate() returns the result of update() to the bit and changes nothing. Filters never allocate.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

#include "fusion/filters/ldl.h"
#include "fusion/motion/motion_model.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::filters {

// The innovation of an update and its covariance. It is unused, and nothing has changed, when the sensor model
// has no derivative at the expected state or cannot see one of the sigma points.
template <int M> struct Innovation {
  linear::Vector<M> nu = linear::Vector<M>::Zero();
  linear::Matrix<M> s = linear::Matrix<M>::Identity();
  double nis = 0.0;          // nu' S^-1 nu
  double determinant = 1.0;  // of S
  bool used = false;

  // Returns the logarithm of the measurement's likelihood, given all earlier measurements.
  double log_likelihood() const { return -0.5 * (nis + std::log(determinant) + M * std::log(2.0 * std::numbers::pi)); }
};

template <class F, class M, class S>
concept Filter = motion::Model<M> && sensors::Model<S> &&
    requires(const F& filter, const M& model, const S& sensor, linear::Gaussian<M::kStates>& state,
             const linear::Gaussian<M::kStates>& kept, const sensors::Measurement<S::kDimension>& z, double dt) {
  {filter.predict(model, state, dt)};
  { filter.innovate(model, sensor, z, kept) } -> std::same_as<Innovation<S::kDimension>>;
  { filter.update(model, sensor, z, state) } -> std::same_as<Innovation<S::kDimension>>;
};

}  // namespace ttf::fusion::filters
