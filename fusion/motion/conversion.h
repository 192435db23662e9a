// Converts an estimate from one layout to another, to first order. The IMM needs it to mix different motion
// models (filters/imm.h).
//
// The conversion goes through (x, y, vx, vy, ax, ay). The source may lack components: a constant-velocity model
// has no acceleration. The destination then keeps its own belief of these, uncorrelated with the rest. A
// certain zero instead would make the destination certain of unmeasured quantities (Granstroem, Willett,
// Bar-Shalom: "Systematic approach to IMM mixing for unequal dimension states", IEEE TAES 51(4), 2015).
//   polar to Cartesian:  v = speed t,  a = acceleration t + speed turn_rate n,  t = (cos h, sin h), n = (-sin h, cos h)
//   Cartesian to polar:  h = course of v, speed = |v|, turn_rate = (v x a) / v^2, acceleration = a . t
//   If the destination believes that the object reverses, heading and speed change their sign.
// Below kSlowest an object has no course: the destination keeps its own heading and all later components. Below
// kTurning the quotient of acceleration and speed is meaningless: the destination keeps its own turn rate and
// acceleration.
#pragma once

#include <cmath>
#include <numbers>

#include "fusion/motion/angles.h"
#include "fusion/motion/kernels.h"
#include "fusion/motion/motion_model.h"

namespace ttf::fusion::motion {

inline constexpr double kTurning = 1.0;  // [m/s]

// An estimate of (x, y, vx, vy, ax, ay), or of only the first four.
struct Whole {
  linear::Gaussian<6> estimate;
  bool has_acceleration = false;
};

template <Model From> Whole whole(const linear::Gaussian<From::kStates>& from) {
  constexpr int kN = From::kStates;
  Whole to{.estimate = {}, .has_acceleration = !(From::kCartesian && kN == 4)};
  linear::Vector<6>& x = to.estimate.x;
  if constexpr (From::kCartesian) {
    x.template head<kN>() = from.x;
    to.estimate.p.template topLeftCorner<kN, kN>() = from.p;
  } else {
    linear::Matrix<6, kN> j = linear::Matrix<6, kN>::Zero();
    const double c = std::cos(from.x(2)), s = std::sin(from.x(2)), speed = from.x(3), rate = from.x(4);
    double along = 0.0;
    if constexpr (kN == 6) along = from.x(5);
    x << from.x(0), from.x(1), speed * c, speed * s, along * c - speed * rate * s, along * s + speed * rate * c;
    j(0, 0) = j(1, 1) = 1.0;
    for (int i = 2; i < 6; i += 2) {  // both vectors turn with the heading
      j(i, 2) = -x(i + 1);
      j(i + 1, 2) = x(i);
    }
    j(2, 3) = c;
    j(3, 3) = s;
    j(4, 3) = -rate * s;
    j(5, 3) = rate * c;
    j(4, 4) = -speed * s;
    j(5, 4) = speed * c;
    if constexpr (kN == 6) {
      j(4, 5) = c;
      j(5, 5) = s;
    }
    to.estimate.p = sandwich<6, kN>(j, from.p);
  }
  return to;
}

template <Model To>
linear::Gaussian<To::kStates> from_whole(const Whole& from, const linear::Gaussian<To::kStates>& own) {
  constexpr int kN = To::kStates;
  const linear::Vector<6>& w = from.estimate.x;
  linear::Gaussian<kN> to = own;
  linear::Matrix<kN, 6> j = linear::Matrix<kN, 6>::Zero();
  j(0, 0) = j(1, 1) = 1.0;
  to.x(0) = w(0);
  to.x(1) = w(1);
  int known = 2;
  if constexpr (To::kCartesian) {
    known = from.has_acceleration ? kN : 4;
    for (int i = 2; i < known; ++i) {
      j(i, i) = 1.0;
      to.x(i) = w(i);
    }
  } else if (const double squared = w(2) * w(2) + w(3) * w(3); squared >= kSlowest * kSlowest) {
    known = 4;
    const double speed = std::sqrt(squared), course = std::atan2(w(3), w(2));
    const double sign = std::abs(to_half_turn(course - own.x(2))) > 0.5 * std::numbers::pi ? -1.0 : 1.0;
    const double c = sign / speed * w(2), s = sign / speed * w(3);
    to.x(2) = std::atan2(s, c);
    to.x(3) = sign * speed;
    j(2, 2) = -w(3) / squared;
    j(2, 3) = w(2) / squared;
    j(3, 2) = c;
    j(3, 3) = s;
    if (from.has_acceleration && speed >= kTurning) {
      known = kN;
      const double rate = (w(2) * w(5) - w(3) * w(4)) / squared;
      to.x(4) = rate;
      j(4, 2) = (w(5) - 2.0 * w(2) * rate) / squared;
      j(4, 3) = (-w(4) - 2.0 * w(3) * rate) / squared;
      j(4, 4) = -w(3) / squared;
      j(4, 5) = w(2) / squared;
      if constexpr (kN == 6) {
        const double along = c * w(4) + s * w(5);
        to.x(5) = along;
        j(5, 2) = (sign * w(4) / speed) - along * w(2) / squared;
        j(5, 3) = (sign * w(5) / speed) - along * w(3) / squared;
        j(5, 4) = c;
        j(5, 5) = s;
      }
    }
  }
  const linear::Matrix<kN> p = sandwich<kN, 6>(j, from.estimate.p);
  for (int i = 0; i < kN; ++i)
    for (int k = 0; k < kN; ++k)
      if (i < known || k < known) to.p(i, k) = i < known && k < known ? p(i, k) : 0.0;
  return to;
}

template <class A, class B>
inline constexpr bool kSameLayout = A::kCartesian == B::kCartesian&& A::kStates == B::kStates;

template <Model From, Model To>
linear::Gaussian<To::kStates> converted(const linear::Gaussian<From::kStates>& from,
                                        const linear::Gaussian<To::kStates>& own) {
  if constexpr (kSameLayout<From, To>)
    return from;
  else
    return from_whole<To>(whole<From>(from), own);
}

}  // namespace ttf::fusion::motion
