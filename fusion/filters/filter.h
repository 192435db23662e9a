// What a filter is: a value without state of its own that moves a normal distribution with a motion model and updates
// it with a sensor model. Filters: Kalman (linear models), Extended, Unscented; several motion models at once: imm.h;
// systematic errors that are carried, not estimated: consider.h. innovate() is what update() finds, to the bit, and
// changes nothing: what a gate asks. Nothing here allocates.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

#include "fusion/filters/ldl.h"
#include "fusion/motion/motion_model.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::filters {

// What an update found: the innovation and its covariance. Not used (nothing changed) where the sensor model has no
// derivative at the expected state, or sees one of the sigma points not.
template <int M> struct Innovation {
  linear::Vector<M> nu = linear::Vector<M>::Zero();
  linear::Matrix<M> s = linear::Matrix<M>::Identity();
  double nis = 0.0;          // nu' S^-1 nu
  double determinant = 1.0;  // of S
  bool used = false;

  // Of the measurement, given all before it.
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
