// The estimator over a kernel: one motion model under a filter (single.h), or several (interacting.h). It chooses the
// sensor's model by the observation's kind, and starts an object.
//
// A polar state needs a course to begin with: with heading and speed unknown, nothing derived at one heading holds, and
// a filter that starts there errs for good. So where a kernel needs a course, an object moves by constant velocity
// until it is known that it moves, and where to: its velocity's spread (the root of its covariance's trace) is at most
// kKnown of its speed, 0.25 rad across. Then it is converted (fusion/motion/conversion.h). The accelerations until
// then are white noise of the density that in one second gives the velocity the spread that an unknown constant
// acceleration gives it, initial_acceleration_sigma^2 times 1 s. Something that stands, or creeps, stays so; what has
// stood until its course is forgotten (kForgotten) begins again.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/check.h"
#include "fusion/estimators/estimator.h"
#include "fusion/estimators/single.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"

namespace ttf::fusion::estimators {

inline constexpr double kKnown = 0.25;

inline bool at_the_origin(const sensors::Mounting& mounting) {
  return mounting.position.x() == 0.0 && mounting.position.y() == 0.0 && mounting.yaw == 0.0;
}
// Position and velocity as one observation has them, `velocity_variance` in every direction it says nothing of; of a
// sensor at the origin where `sensor` is null.
linear::Gaussian<4> first_estimate(const sensors::Observation& observation, double velocity_variance,
                                   const sensors::KnownSensor* sensor);
// Whether it is known that this moves, and where to.
bool knows_course(const linear::Gaussian<4>& state);

template <class F, class Kernel> class ModelEstimator final : public Estimator {
 public:
  ModelEstimator(const config::TrackerConfig& config, const Kernel& kernel)
      : kernel_(kernel), velocity_variance_(config.initial_velocity_sigma * config.initial_velocity_sigma),
        sensors_(config.sensors), young_{.model = motion::ConstantVelocity(config.initial_acceleration_sigma *
                                                                           config.initial_acceleration_sigma)} {}

  Estimate initial(const sensors::Observation& observation) const override {
    const linear::Gaussian<4> first =
        first_estimate(observation, velocity_variance_, known(sensors_, observation.sensor));
    if constexpr (Kernel::kNeedsCourse)
      return first;
    else
      return kernel_.from(first);
  }

  void predict(Estimate& estimate, double dt) const override {
    TTF_CHECK(dt >= 0.0, "prediction by {} s", dt);
    if (dt == 0.0) return;
    with(estimate, [&](const auto& kernel, auto& own) { kernel.predict(own, dt); });
  }

  std::optional<double> distance_squared(const Estimate& estimate,
                                         const sensors::Observation& observation) const override {
    return with(estimate, [&](const auto& kernel, const auto& own) {
      return through_sensor(observation, [&](const auto& sensor, const auto& z) -> std::optional<double> {
        const auto innovation = kernel.innovate(sensor, z, own);
        if (!innovation.used) return std::nullopt;
        return innovation.nis;
      });
    });
  }

  std::optional<Fit> fit(const Estimate& estimate, const sensors::Observation& observation) const override {
    return with(estimate, [&](const auto& kernel, const auto& own) {
      return through_sensor(observation, [&](const auto& sensor, const auto& z) -> std::optional<Fit> {
        const auto innovation = kernel.innovate(sensor, z, own);
        if (!innovation.used) return std::nullopt;
        return Fit{innovation.nis, std::exp(innovation.log_likelihood())};
      });
    });
  }

  void update(Estimate& estimate, const sensors::Observation& observation) const override {
    with(estimate, [&](const auto& kernel, auto& own) { take_in(kernel, own, observation); });
    follow_course(estimate);
  }

  // What each explanation makes of the estimate is of one layout: whether the course is known is asked at the end.
  void update(Estimate& estimate, std::span<const Explanation> explanations) const override {
    bool observed = false;
    with(estimate, [&](const auto& kernel, auto& own) {
      const auto before = own;
      double weight = 0.0;
      for (const Explanation& explanation : explanations) {
        if (explanation.weight <= 0.0) continue;
        auto after = before;
        if (explanation.observation) {
          take_in(kernel, after, *explanation.observation);
          observed = true;
        }
        if (weight > 0.0)
          kernel.merge(own, weight, after, explanation.weight);
        else
          own = after;
        weight += explanation.weight;
      }
    });
    if (observed) follow_course(estimate);
  }

  linear::Gaussian<2> position(const Estimate& estimate) const override {
    return with(estimate, [](const auto& kernel, const auto& own) { return kernel.position(own); });
  }
  Cartesian cartesian(const Estimate& estimate) const override {
    return with(estimate, [](const auto& kernel, const auto& own) { return kernel.cartesian(own); });
  }

 private:
  // Over to the kernel once the course is known, and back where it is lost.
  void follow_course(Estimate& estimate) const {
    if constexpr (Kernel::kNeedsCourse) {
      if (const auto* young = std::get_if<linear::Gaussian<4>>(&estimate)) {
        if (knows_course(*young)) estimate = kernel_.from(linear::Gaussian<4>(*young));
      } else if (const auto lost = kernel_.without_course(std::get<typename Kernel::Own>(estimate))) {
        estimate = *lost;
      }
    }
  }

  template <class E, class Body> auto with(E& estimate, const Body& body) const {
    if constexpr (Kernel::kNeedsCourse)
      if (auto* young = std::get_if<linear::Gaussian<4>>(&estimate)) return body(young_, *young);
    auto* own = std::get_if<typename Kernel::Own>(&estimate);
    TTF_CHECK(own, "an estimate of another estimator: alternative {}", estimate.index());
    return body(kernel_, *own);
  }

  // In one place, for the sake of the hot path: of two the compiler would inline neither filter.
  template <class K, class Own>
  [[gnu::noinline]] void take_in(const K& kernel, Own& own, const sensors::Observation& observation) const {
    through_sensor(observation, [&](const auto& sensor, const auto& z) { kernel.update(sensor, z, own); });
  }

  // What is a position has been placed in the vehicle's axes before (fusion/sensors/known_sensor.h).
  template <class Body> auto through_sensor(const sensors::Observation& o, const Body& body) const {
    if (o.kind == sensors::ObservationKind::kPosition)
      return body(sensors::Position{},
                  sensors::Measurement<2>{o.z.template head<2>(), o.r.template topLeftCorner<2, 2>()});
    const sensors::Measurement<3> z{o.z, o.r};
    if (const sensors::KnownSensor* sensor = known(sensors_, o.sensor);
        sensor != nullptr && !at_the_origin(sensor->mounting))
      return body(sensors::Mounted<sensors::RangeBearingRate>(sensor->mounting), z);
    return body(sensors::RangeBearingRate{}, z);
  }

  Kernel kernel_;
  double velocity_variance_;
  std::vector<sensors::KnownSensor> sensors_;
  Single<F, motion::ConstantVelocity> young_;
};

}  // namespace ttf::fusion::estimators
