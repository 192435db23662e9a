#include "experiments/sweep/expected_heading.h"

#include <algorithm>
#include <cmath>

namespace ttf::experiments::sweep {
namespace {

constexpr double kTightest = 0.2;  // [1/m], of a car's bends
constexpr double kForever = 1e9;   // [s]

}  // namespace

double HeadingRecursion::rate_sigma(double speed) const {
  return std::min(tracker_.initial_turn_rate_sigma, kTightest * std::abs(speed));
}

void HeadingRecursion::predict(double dt, double speed) {
  const double s0 = tracker_.initial_turn_rate_sigma, s = rate_sigma(speed);
  const double t = tracker_.turn_noise > 0.0 ? std::min(kForever, 2.0 * s0 * s0 / tracker_.turn_noise) : kForever;
  Eigen::Matrix2d f = Eigen::Matrix2d::Identity(), q = Eigen::Matrix2d::Zero();
  f(1, 1) = t > 0.0 ? std::exp(-dt / t) : 0.0;
  if (t > 0.0) {
    const double x = dt / t, g = -t * std::expm1(-x);
    f(0, 1) = g;
    // The exact form cancels for a short dt.
    q(0, 0) = s * s * (x < 0.01 ? 2.0 / 3.0 * dt * dt * x : t * (2.0 * dt - 2.0 * g - g * g / t));
    q(0, 1) = q(1, 0) = s * s * g * g / t;
    q(1, 1) = s * s * -std::expm1(-2.0 * x);
  }
  q(0, 0) += tracker_.heading_noise * dt;
  moments_.believed = (f * moments_.believed * f.transpose() + q).eval();
  moments_.actual = (f * moments_.actual * f.transpose()).eval();
}

void HeadingRecursion::see(GlobalTime measured, double variance, double speed) {
  if (!known_) {
    known_ = true;
    newest_ = measured;
    const double rate = tracker_.initial_turn_rate_sigma;
    moments_.believed = Eigen::Vector2d(variance, rate * rate).asDiagonal();
    moments_.actual = Eigen::Vector2d(variance, 0.0).asDiagonal();
    return;
  }
  if (measured > newest_) {
    predict((measured - newest_).seconds(), speed);
    newest_ = measured;
  }
  const Eigen::Vector2d gain = moments_.believed.col(0) / (moments_.believed(0, 0) + variance);
  Eigen::Matrix2d rest = Eigen::Matrix2d::Identity();
  rest.col(0) -= gain;
  const Eigen::Matrix2d noise = variance * gain * gain.transpose();
  moments_.believed = (rest * moments_.believed * rest.transpose() + noise).eval();
  moments_.actual = (rest * moments_.actual * rest.transpose() + noise).eval();
}

HeadingRecursion::Moments HeadingRecursion::at(GlobalTime use, double speed) const {
  if (!known_) return {Eigen::Vector2d(0.0, std::pow(rate_sigma(speed), 2)).asDiagonal(), Eigen::Matrix2d::Zero()};
  HeadingRecursion later = *this;
  if (use > newest_) later.predict((use - newest_).seconds(), speed);
  return later.moments_;
}

}  // namespace ttf::experiments::sweep
