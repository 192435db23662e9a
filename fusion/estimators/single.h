// The kernel of one motion model under one filter, for ModelEstimator.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "fusion/estimators/estimate.h"
#include "fusion/filters/filter.h"
#include "fusion/filters/merge.h"
#include "fusion/motion/conversion.h"

namespace ttf::fusion::estimators {

// Standard deviation of a heading [rad] above which no linearisation at it holds.
inline constexpr double kForgotten = 0.7;

// Bounds the heading's variance by that of a uniform distribution over the circle. White turn acceleration
// would exceed it for an object that stands for long. Scaling row and column alike keeps the covariance
// positive.
template <class M> void bound_heading(linear::Gaussian<M::kStates>& state) {
  if constexpr (!M::kCartesian) {
    constexpr double kUnknown = std::numbers::pi * std::numbers::pi / 3.0;
    const double variance = state.p(M::kHeading, M::kHeading);
    if (variance <= kUnknown) return;
    const double scale = std::sqrt(kUnknown / variance);
    state.p.row(M::kHeading) *= scale;
    state.p.col(M::kHeading) *= scale;
  }
}

template <class F, motion::Model M> struct Single {
  using Own = linear::Gaussian<M::kStates>;
  static constexpr bool kNeedsCourse = !M::kCartesian;

  M model{};
  Own prior{};  // an object's before its first observation
  [[no_unique_address]] F filter{};

  // Starts from position and velocity; the other components come from the prior.
  Own from(const linear::Gaussian<4>& known) const {
    return motion::converted<motion::ConstantVelocity, M>(known, prior);
  }
  // Returns position and velocity of an object that has lost its course, and no value while the course is
  // known. The object may move at its speed in any direction.
  std::optional<linear::Gaussian<4>> without_course(const Own& own) const {
    if constexpr (kNeedsCourse) {
      if (own.p(M::kHeading, M::kHeading) <= kForgotten * kForgotten) return std::nullopt;
      linear::Gaussian<4> known;
      const motion::Kinematics k = M::template kinematics<motion::kWithVelocity>(own.x);
      known.x << k.position, k.velocity;
      known.p.template topLeftCorner<2, 2>() = own.p.template topLeftCorner<2, 2>();
      known.p(2, 2) = known.p(3, 3) = own.x(M::kSpeed) * own.x(M::kSpeed) + own.p(M::kSpeed, M::kSpeed);
      return known;
    }
    return std::nullopt;
  }
  void predict(Own& own, double dt) const {
    filter.predict(model, own, dt);
    bound_heading<M>(own);
  }
  template <sensors::Model S>
  filters::Innovation<S::kDimension> innovate(const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                              const Own& own) const {
    return filter.innovate(model, sensor, z, own);
  }
  template <sensors::Model S>
  void update(const S& sensor, const sensors::Measurement<S::kDimension>& z, Own& own) const {
    filter.update(model, sensor, z, own);
  }
  void merge(Own& first, double a, const Own& second, double b) const { filters::merge<M>(first, a, second, b); }
  linear::Gaussian<2> position(const Own& own) const {
    return {own.x.template head<2>(), own.p.template topLeftCorner<2, 2>()};
  }
  Cartesian cartesian(const Own& own) const {
    if constexpr (M::kCartesian && M::kStates == 6)
      return own;
    else
      return motion::whole<M>(own).estimate;
  }
  linear::Vector<2> velocity(const Own& own) const {
    return M::template kinematics<motion::kWithVelocity>(own.x).velocity;
  }
};

}  // namespace ttf::fusion::estimators
