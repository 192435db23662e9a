#include "fusion/estimators/considering.h"

#include "fusion/estimators/make.h"
#include "fusion/motion/constant_acceleration.h"

namespace ttf::fusion::estimators {

AllBiases::AllBiases(std::span<const sensors::KnownSensor> sensors) {
  TTF_CHECK(count_biases(sensors) <= sensors::kMostBiases, "{} biases", count_biases(sensors));
  int next = 0;
  for (const sensors::KnownSensor& sensor : sensors) {
    const sensors::SystematicErrors& errors = sensor.errors;
    sensors::OwnBiases& own = own_.emplace_back();
    own.axes = errors.axes;
    own.time_variance = errors.sigma(3) * errors.sigma(3);
    for (int i = 0; i < 4; ++i) {
      if (!(errors.sigma(i) > 0.0)) continue;
      covariance_(next, next) = errors.sigma(i) * errors.sigma(i);
      own.index[static_cast<std::size_t>(i)] = next++;
    }
  }
}

linear::Matrix<4, 3> first_jacobian(const sensors::Observation& observation) {
  linear::Matrix<4, 3> j = linear::Matrix<4, 3>::Zero();
  if (observation.kind == sensors::ObservationKind::kPosition) {
    j(0, 0) = j(1, 1) = 1.0;
    return j;
  }
  const double range = observation.z(0), rate = observation.z(2);
  const sensors::Mounting& from = observation.from;
  const double bearing = observation.z(1) + from.yaw;
  const double c = std::cos(bearing), s = std::sin(bearing);
  j.col(0) << c, s, 0.0, 0.0;
  j.col(1) << -range * s, range * c, -rate * s, rate * c;
  if (from.velocity.x() != 0.0 || from.velocity.y() != 0.0) {
    const linear::Vector<2> sight(c, s), left(-s, c);
    j.col(1).tail<2>() += left.dot(from.velocity) * sight + sight.dot(from.velocity) * left;
  }
  j.col(2) << 0.0, 0.0, c, s;
  return j;
}

std::shared_ptr<const Estimator> make_considering(const config::TrackerConfig& config) {
  TTF_CHECK(config.filter == config::FilterKind::kExtended, "considered under filter {}",
            static_cast<int>(config.filter));
  const auto make = [&](auto model) -> std::shared_ptr<const Estimator> {
    using M = decltype(model);
    model.drift_density = config.drift_density();
    return std::make_shared<ConsideringEstimator<M>>(config, model, prior_of<M>(config));
  };
  if (config.motion == config::MotionModel::kConstantAcceleration)
    return make(motion::ConstantAcceleration(config.process_noise, config.noise_across()));
  TTF_CHECK(config.motion == config::MotionModel::kConstantVelocity, "considered with motion {}",
            static_cast<int>(config.motion));
  return make(motion::ConstantVelocity(config.process_noise, config.noise_across()));
}

}  // namespace ttf::fusion::estimators
