// A motion model is a small header that derives from a layout. With dt >= 0 in seconds and the state
// x it has:
//   move(x, dt)      the state after dt;
//   jacobian(x, dt)  d move / d x;
//   noise(x, dt)     the covariance that white noise adds within dt from x on, symmetric positive semi-definite.
// Tests hold every model to three laws. One transition by dt equals two shorter ones, up to rounding. The
// jacobian is the derivative. The noise is the integral of the driving noise along the path of x, to first
// order of that noise. A linear model also has step(dt). A chain of integrators (integrator_chain.h) also moves
// covariances, at a fraction of the matrix product's cost.
//
// A layout names the components of a state and derives its kinematics. There are two layouts:
//   Cartesian<4>  (x, y, vx, vy)                      Cartesian<6>  (x, y, vx, vy, ax, ay)
//   Polar<5>      (x, y, heading, speed, turn rate)   Polar<6>      (..., acceleration along the heading)
// The heading of a Cartesian state is its course, the direction of its velocity. The heading of a polar state
// is the direction of the object's front; its speed is negative in reverse.
#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "fusion/motion/angles.h"
#include "fusion/motion/kinematics.h"

namespace ttf::fusion::motion {

// Below this speed [m/s] a course gives no heading.
inline constexpr double kSlowest = 0.1;

template <int N> struct Cartesian {
  static_assert(N == 4 || N == 6);
  static constexpr int kStates = N;
  static constexpr bool kCartesian = true;

  static linear::Vector<N> difference(const linear::Vector<N>& a, const linear::Vector<N>& b) { return a - b; }
  static void normalise(linear::Vector<N>&) {}

  template <int Parts> static Kinematics kinematics(const linear::Vector<N>& x) {
    Kinematics k{.position = x.template head<2>(), .velocity = x.template segment<2>(2)};
    if constexpr (Parts == kWithHeading) {
      k.has_heading = k.velocity.squaredNorm() >= kSlowest * kSlowest;
      if (k.has_heading) k.heading = std::atan2(x(3), x(2));
    }
    return k;
  }

  // d (x, y, vx, vy, heading) / d (the first four components).
  static linear::Matrix<5, 4> kinematics_jacobian(const linear::Vector<N>& x) {
    linear::Matrix<5, 4> j = linear::Matrix<5, 4>::Identity();
    const double squared = x.template segment<2>(2).squaredNorm();
    if (squared >= kSlowest * kSlowest) {
      j(4, 2) = -x(3) / squared;
      j(4, 3) = x(2) / squared;
    }
    return j;
  }
};

template <int N> struct Polar {
  static_assert(N == 5 || N == 6);
  static constexpr int kStates = N;
  static constexpr bool kCartesian = false;
  static constexpr int kHeading = 2, kSpeed = 3, kTurnRate = 4, kAcceleration = 5;

  static linear::Vector<N> difference(const linear::Vector<N>& a, const linear::Vector<N>& b) {
    linear::Vector<N> d = a - b;
    d(kHeading) = to_half_turn(d(kHeading));
    return d;
  }
  static void normalise(linear::Vector<N>& x) { x(kHeading) = to_half_turn(x(kHeading)); }

  template <int Parts> static Kinematics kinematics(const linear::Vector<N>& x) {
    Kinematics k{.position = x.template head<2>()};
    if constexpr (Parts >= kWithVelocity)
      k.velocity = x(kSpeed) * linear::Vector<2>(std::cos(x(kHeading)), std::sin(x(kHeading)));
    k.heading = x(kHeading);
    k.has_heading = true;
    return k;
  }

  static linear::Matrix<5, 4> kinematics_jacobian(const linear::Vector<N>& x) {
    const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
    linear::Matrix<5, 4> j = linear::Matrix<5, 4>::Zero();
    j(0, 0) = j(1, 1) = j(4, kHeading) = 1.0;
    j(2, kHeading) = -x(kSpeed) * s;
    j(3, kHeading) = x(kSpeed) * c;
    j(2, kSpeed) = c;
    j(3, kSpeed) = s;
    return j;
  }
};

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
