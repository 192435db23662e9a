#include "fusion/estimators/estimator.h"

#include <cmath>

#include "core/check.h"
#include "fusion/estimators/make.h"

namespace ttf::fusion::estimators {
namespace {

// Converts an estimate from the sensor's place and axes to those of the tracks. Along the line of sight the sensor's own
// velocity adds to the measured one; across it nothing is measured.
void carry_over(linear::Gaussian<4>& estimate, const sensors::Mounting& mounting) {
  const double c = std::cos(mounting.yaw), s = std::sin(mounting.yaw);
  linear::Matrix<4> j = linear::Matrix<4>::Zero();
  j.topLeftCorner<2, 2>() << c, -s, s, c;
  j.bottomRightCorner<2, 2>() = j.topLeftCorner<2, 2>();
  estimate.x = (j * estimate.x).eval();
  if (mounting.velocity.x() != 0.0 || mounting.velocity.y() != 0.0) {
    const linear::Vector<2> sight = estimate.x.head<2>().normalized();
    estimate.x.tail<2>() += sight.dot(mounting.velocity) * sight;
  }
  estimate.x.head<2>() += mounting.position;
  estimate.p = motion::sandwich<4, 4>(j, estimate.p);
}

template <int N> void shift(linear::Gaussian<N>& state, const Displacement& d) {
  state.x.template head<2>() += d.by;
  state.p.template topLeftCorner<2, 2>() += d.spread;
}
template <int N> void shift(WithBiases<N>& own, const Displacement& d) { shift(own.state, d); }
void shift(StraightOrTurning& own, const Displacement& d) {
  std::apply([&](auto&... mode) { (shift(mode, d), ...); }, own.estimates);
}

}  // namespace

void displace(Estimate& estimate, const Displacement& d) {
  std::visit([&](auto& own) { shift(own, d); }, estimate);
}

linear::Gaussian<4> first_estimate(const sensors::Observation& observation, double velocity_variance) {
  linear::Gaussian<4> estimate;
  if (observation.kind == sensors::ObservationKind::kPosition) {
    estimate.x.head<2>() = observation.z.head<2>();
    estimate.p.topLeftCorner<2, 2>() = observation.r.topLeftCorner<2, 2>();
    estimate.p(2, 2) = estimate.p(3, 3) = velocity_variance;
    return estimate;
  }
  const double range = observation.z(0), c = std::cos(observation.z(1)), s = std::sin(observation.z(1));
  linear::Matrix<2> rotation;
  rotation << c, -s, s, c;
  estimate.x.head<2>() = range * rotation.col(0);
  estimate.x.tail<2>() = observation.z(2) * rotation.col(0);
  const linear::Vector<2> position(observation.r(0, 0), range * range * observation.r(1, 1));
  const linear::Vector<2> velocity(observation.r(2, 2), velocity_variance);
  estimate.p.topLeftCorner<2, 2>() = rotation * position.asDiagonal() * rotation.transpose();
  estimate.p.bottomRightCorner<2, 2>() = rotation * velocity.asDiagonal() * rotation.transpose();
  linear::symmetrise<4>(estimate.p);
  if (!at_the_origin(observation.from)) carry_over(estimate, observation.from);
  return estimate;
}

sensors::Observation as_first(const sensors::Observation& observation, double velocity_variance) {
  if (observation.kind == sensors::ObservationKind::kPosition || rate_counts(observation.rate_span, velocity_variance))
    return observation;
  sensors::Observation without = observation;
  without.z(2) = 0.0;
  without.r.row(2).setZero();
  without.r.col(2).setZero();
  without.r(2, 2) = velocity_variance;
  return without;
}

bool has_course(const linear::Gaussian<4>& state) {
  const double speed_squared = state.x.tail<2>().squaredNorm();
  return speed_squared >= motion::kSlowest * motion::kSlowest &&
         state.p(2, 2) + state.p(3, 3) <= kKnown * kKnown * speed_squared;
}

std::shared_ptr<const Estimator> make_estimator(const config::TrackerConfig& config) {
  if (config.systematic == config::SystematicErrorsAre::kConsidered) return make_considering(config);
  switch (config.motion) {
    case config::MotionModel::kConstantVelocity:
    case config::MotionModel::kConstantAcceleration: return make_straight(config);
    case config::MotionModel::kCtrv:
    case config::MotionModel::kCtra: return make_turning(config);
    case config::MotionModel::kInteracting: return make_interacting(config);
  }
  TTF_CHECK(false, "motion model {}", static_cast<int>(config.motion));
}

}  // namespace ttf::fusion::estimators
