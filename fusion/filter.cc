#include "fusion/filter.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace ttf::fusion {
namespace {

void symmetrise(Covariance& p) { p = 0.5 * (p + p.transpose()).eval(); }

template <int Dimension>
double normalised(const Innovation& innovation) {
  const Eigen::Matrix<double, Dimension, Dimension> s =
      innovation.s.template topLeftCorner<Dimension, Dimension>();
  const Eigen::Matrix<double, Dimension, 1> nu = innovation.nu.template head<Dimension>();
  return nu.dot(s.ldlt().solve(nu));
}

template <int Dimension>
void joseph(Estimate& estimate, const Observation& observation, const Innovation& innovation) {
  const Eigen::Matrix<double, Dimension, 6> h = innovation.h.template topRows<Dimension>();
  const Eigen::Matrix<double, Dimension, Dimension> s =
      innovation.s.template topLeftCorner<Dimension, Dimension>();
  const Eigen::Matrix<double, Dimension, Dimension> r =
      observation.r.template topLeftCorner<Dimension, Dimension>();
  const Eigen::Matrix<double, 6, Dimension> k = s.ldlt().solve(h * estimate.p).transpose();
  estimate.x += k * innovation.nu.template head<Dimension>();
  const Covariance a = Covariance::Identity() - k * h;
  estimate.p = (a * estimate.p * a.transpose() + k * r * k.transpose()).eval();
  symmetrise(estimate.p);
}

}  // namespace

double wrap_angle(double angle) {
  constexpr double kPi = std::numbers::pi;
  double wrapped = std::remainder(angle, 2.0 * kPi);
  if (wrapped <= -kPi) wrapped += 2.0 * kPi;
  return wrapped;
}

void predict(Estimate& estimate, MotionModel motion, double process_noise, double dt) {
  TTF_CHECK(dt >= 0.0, "prediction by {} s", dt);
  if (dt == 0.0) return;
  const bool acceleration = motion == MotionModel::kConstantAcceleration;
  Covariance f = Covariance::Identity();
  f(0, 2) = f(1, 3) = dt;
  if (acceleration) {
    f(0, 4) = f(1, 5) = 0.5 * dt * dt;
    f(2, 4) = f(3, 5) = dt;
  }
  estimate.x = (f * estimate.x).eval();
  estimate.p = (f * estimate.p * f.transpose()).eval();
  const double q = process_noise, dt2 = dt * dt, dt3 = dt2 * dt;
  for (int axis = 0; axis < 2; ++axis) {
    const int p = axis, v = axis + 2, a = axis + 4;
    if (acceleration) {
      estimate.p(p, p) += q * dt3 * dt2 / 20.0;
      estimate.p(p, v) += q * dt2 * dt2 / 8.0;
      estimate.p(p, a) += q * dt3 / 6.0;
      estimate.p(v, v) += q * dt3 / 3.0;
      estimate.p(v, a) += q * dt2 / 2.0;
      estimate.p(a, a) += q * dt;
    } else {
      estimate.p(p, p) += q * dt3 / 3.0;
      estimate.p(p, v) += q * dt2 / 2.0;
      estimate.p(v, v) += q * dt;
    }
    estimate.p(v, p) = estimate.p(p, v);
    estimate.p(a, p) = estimate.p(p, a);
    estimate.p(a, v) = estimate.p(v, a);
  }
  symmetrise(estimate.p);
}

Eigen::Vector3d expected(ObservationKind kind, const State& x) {
  if (kind == ObservationKind::kPosition) return {x(0), x(1), 0.0};
  const double range = std::hypot(x(0), x(1));
  return {range, std::atan2(x(1), x(0)), (x(0) * x(2) + x(1) * x(3)) / range};
}

Eigen::Matrix<double, 3, 6> jacobian(ObservationKind kind, const State& x) {
  Eigen::Matrix<double, 3, 6> h = Eigen::Matrix<double, 3, 6>::Zero();
  if (kind == ObservationKind::kPosition) {
    h(0, 0) = h(1, 1) = 1.0;
    return h;
  }
  const double range2 = x(0) * x(0) + x(1) * x(1), range = std::sqrt(range2), range3 = range2 * range;
  const double cross = x(1) * x(2) - x(0) * x(3);  // so that d(rate)/dx = y cross / r^3
  h(0, 0) = x(0) / range;
  h(0, 1) = x(1) / range;
  h(1, 0) = -x(1) / range2;
  h(1, 1) = x(0) / range2;
  h(2, 0) = x(1) * cross / range3;
  h(2, 1) = -x(0) * cross / range3;
  h(2, 2) = x(0) / range;
  h(2, 3) = x(1) / range;
  return h;
}

Innovation innovate(const Estimate& estimate, const Observation& observation) {
  constexpr double kSmallestRange = 1e-3;
  Innovation innovation;
  innovation.dimension = dimension_of(observation.kind);
  if (observation.kind == ObservationKind::kRangeBearingRate &&
      std::hypot(estimate.x(0), estimate.x(1)) < kSmallestRange)
    return innovation;
  innovation.h = jacobian(observation.kind, estimate.x);
  innovation.nu = observation.z - expected(observation.kind, estimate.x);
  if (observation.kind == ObservationKind::kRangeBearingRate) innovation.nu(1) = wrap_angle(innovation.nu(1));
  innovation.s = innovation.h * estimate.p * innovation.h.transpose() + observation.r;
  innovation.s = (0.5 * (innovation.s + innovation.s.transpose())).eval();
  innovation.distance_squared =
      innovation.dimension == 2 ? normalised<2>(innovation) : normalised<3>(innovation);
  innovation.valid = true;
  return innovation;
}

void update(Estimate& estimate, const Observation& observation, const Innovation& innovation) {
  TTF_CHECK(innovation.valid, "update without a derivative");
  if (innovation.dimension == 2)
    joseph<2>(estimate, observation, innovation);
  else
    joseph<3>(estimate, observation, innovation);
}

Estimate initial_estimate(const Observation& observation, const TrackerConfig& config) {
  Estimate estimate;
  const double velocity_variance = config.initial_velocity_sigma * config.initial_velocity_sigma;
  estimate.p(2, 2) = estimate.p(3, 3) = velocity_variance;
  if (observation.kind == ObservationKind::kPosition) {
    estimate.x.head<2>() = observation.z.head<2>();
    estimate.p.topLeftCorner<2, 2>() = observation.r.topLeftCorner<2, 2>();
  } else {
    const double range = observation.z(0), c = std::cos(observation.z(1)), s = std::sin(observation.z(1));
    Eigen::Matrix2d rotation;
    rotation << c, -s, s, c;
    estimate.x.head<2>() = range * rotation.col(0);
    estimate.x.segment<2>(2) = observation.z(2) * rotation.col(0);
    const Eigen::Vector2d position(observation.r(0, 0), range * range * observation.r(1, 1));
    const Eigen::Vector2d velocity(observation.r(2, 2), velocity_variance);
    estimate.p.topLeftCorner<2, 2>() = rotation * position.asDiagonal() * rotation.transpose();
    estimate.p.block<2, 2>(2, 2) = rotation * velocity.asDiagonal() * rotation.transpose();
  }
  if (config.motion == MotionModel::kConstantAcceleration)
    estimate.p(4, 4) = estimate.p(5, 5) =
        config.initial_acceleration_sigma * config.initial_acceleration_sigma;
  symmetrise(estimate.p);
  return estimate;
}

}  // namespace ttf::fusion
