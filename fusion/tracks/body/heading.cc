#include "fusion/tracks/body/heading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::body {
namespace {

// The tightest bend of a car, of 5 m radius [1/m].
constexpr double kTightest = 0.2;
// A rate without noise lasts so long [s].
constexpr double kForever = 1e9;

}  // namespace

Scalar predicted(const Scalar& scalar, double noise, double dt) {
  Scalar later = scalar;
  if (later.known) later.variance += noise * dt;
  return later;
}

double nearest_half_turn(double axis, double expected) {
  constexpr double kPi = std::numbers::pi;
  const double difference = motion::to_half_turn(axis - expected);
  return std::abs(difference) <= 0.5 * kPi ? axis : motion::to_half_turn(axis + kPi);
}

double ahead_by(const Heading& heading, const linear::Gaussian<2>& velocity) {
  constexpr double kLeast = 1e-9;  // [m/s], the standard deviation of a velocity without error
  const linear::Vector<2> along(std::cos(heading.value), std::sin(heading.value));
  return along.dot(velocity.x) / std::max(kLeast, std::sqrt(std::max(0.0, along.dot(velocity.p * along))));
}

void update_front(Heading& heading, const linear::Gaussian<2>& velocity) {
  if (!heading.known) return;
  const double ahead = ahead_by(heading, velocity);
  if (std::abs(ahead) > kResolvesFront) heading.front = ahead > 0.0 ? 1 : -1;
}

void take_front(Heading& heading, const Heading& other) {
  if (!heading.known || heading.front != 0 || other.front == 0) return;
  const bool same = nearest_half_turn(heading.value, other.value) == heading.value;
  heading.front = static_cast<signed char>(same ? other.front : -other.front);
}

Heading unknown_heading(const config::TrackerConfig& config) {
  Heading heading;
  heading.rate_variance = config.initial_turn_rate_sigma * config.initial_turn_rate_sigma;
  return heading;
}

HeadingStep::HeadingStep(const config::TrackerConfig& config, double dt)
    : dt_(dt), most_rate_(config.initial_turn_rate_sigma), walk_(config.heading_noise * dt),
      seconds_(config.turn_noise > 0.0 ? std::min(kForever, 2.0 * most_rate_ * most_rate_ / config.turn_noise)
                                       : kForever) {
  if (!(dt > 0.0) || !(seconds_ > 0.0)) return;
  left_ = std::exp(-dt / seconds_);
  reach_ = -seconds_ * std::expm1(-dt / seconds_);
  gone_ = 1.0 - left_ * left_;
  // 2 T (dt - 2 reach + T / 2 gone), without cancellation for short steps.
  const double ratio = dt / seconds_;
  turned_ = ratio < 0.01 ? 2.0 / 3.0 * dt * dt * ratio * (1.0 - 0.75 * ratio + 0.35 * ratio * ratio)
                         : 2.0 * seconds_ * (dt - 2.0 * reach_ + 0.5 * seconds_ * gone_);
}

Heading HeadingStep::of(const Heading& heading, double speed) const {
  if (!(dt_ > 0.0)) return heading;
  Heading later = heading;
  if (!(seconds_ > 0.0)) {  // it does not turn
    later.rate = later.rate_variance = later.covariance = 0.0;
    if (later.known) later.variance += walk_;
    return later;
  }
  const double s = std::min(most_rate_, kTightest * speed);
  later.rate = left_ * heading.rate;
  later.rate_variance = left_ * left_ * heading.rate_variance + s * s * gone_;
  if (!later.known) return later;
  later.value = motion::to_half_turn(heading.value + reach_ * heading.rate);
  later.variance +=
      2.0 * reach_ * heading.covariance + reach_ * reach_ * heading.rate_variance + walk_ + s * s * turned_;
  later.covariance = left_ * (heading.covariance + reach_ * heading.rate_variance) + s * s * reach_ * reach_ / seconds_;
  return later;
}

// In Joseph form, with h = (1, -age).
void correct(Heading& heading, double measured, double sigma, double likely, double age) {
  const double variance = sigma * sigma;
  if (!heading.known) {
    heading.known = true;
    heading.value = motion::to_half_turn(nearest_half_turn(measured, likely) + age * heading.rate);
    heading.variance = variance + age * age * heading.rate_variance;
    heading.covariance = age * heading.rate_variance;
    return;
  }
  const double then = heading.value - age * heading.rate;
  const double nu = motion::to_half_turn(nearest_half_turn(measured, then) - then);
  const double ph = heading.variance - age * heading.covariance;
  const double pr = heading.covariance - age * heading.rate_variance;
  const double s = ph - age * pr + variance;
  const double gain = ph / s, rate_gain = pr / s;
  const double a11 = 1.0 - gain, a12 = gain * age, a21 = -rate_gain, a22 = 1.0 + rate_gain * age;
  const double p11 = heading.variance, p12 = heading.covariance, p22 = heading.rate_variance;
  heading.value = motion::to_half_turn(heading.value + gain * nu);
  heading.rate += rate_gain * nu;
  heading.variance = a11 * a11 * p11 + 2.0 * a11 * a12 * p12 + a12 * a12 * p22 + gain * gain * variance;
  heading.covariance = a11 * a21 * p11 + (a11 * a22 + a12 * a21) * p12 + a12 * a22 * p22 + gain * rate_gain * variance;
  heading.rate_variance = a21 * a21 * p11 + 2.0 * a21 * a22 * p12 + a22 * a22 * p22 + rate_gain * rate_gain * variance;
}

}  // namespace ttf::fusion::tracks::body
