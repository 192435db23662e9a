// The estimator over a kernel of one motion model under a filter (single.h), or of several (interacting.cc). It
// chooses the sensor's model by the observation's kind and starts objects.
//
// A polar state needs a course to begin with. With unknown heading and speed no linearisation holds, and a
// filter that starts there never recovers. So for a kernel that needs a course, an object first moves by
// constant velocity. Its course is known once the velocity's spread, the root of its covariance's trace, is at
// most kKnown of its speed: 0.25 rad across. Then the estimate is converted (fusion/motion/conversion.h).
//
// Until then the acceleration is white noise. In one second it spreads the velocity as an unknown constant
// acceleration would: its density is initial_acceleration_sigma^2 times 1 s. A standing or creeping object
// stays in this state. An object that stands until its course is forgotten (kForgotten) returns to it.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <variant>

#include "core/check.h"
#include "fusion/estimators/doubtful_rate.h"
#include "fusion/estimators/estimator.h"
#include "fusion/estimators/single.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"

namespace ttf::fusion::estimators {

inline constexpr double kKnown = 0.25;

// Returns position and velocity from one observation, with `velocity_variance` in every unobserved direction, where the mean
// is that of an object which stands.
linear::Gaussian<4> first_estimate(const sensors::Observation& observation, double velocity_variance);
// Returns the observation as the first one of an object whose velocity has this variance.
sensors::Observation as_first(const sensors::Observation& observation, double velocity_variance);
// Returns whether the object is known to move, and in which direction.
bool has_course(const linear::Gaussian<4>& state);

template <class F, class Kernel> class ModelEstimator final : public Estimator {
 public:
  ModelEstimator(const config::TrackerConfig& config, const Kernel& kernel)
      : kernel_(kernel), velocity_variance_(config.initial_velocity_sigma * config.initial_velocity_sigma),
        young_{.model =
                   motion::ConstantVelocity(config.initial_acceleration_sigma * config.initial_acceleration_sigma)} {
    young_.model.drift_density = config.drift_density();
  }

  Estimate initial(const sensors::Observation& observation) const override {
    const linear::Gaussian<4> first = first_estimate(as_first(observation, velocity_variance_), velocity_variance_);
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
      return through_sensor(kernel, own, observation, [&](const auto& sensor, const auto& z) -> std::optional<double> {
        const auto innovation = kernel.innovate(sensor, z, own);
        if (!innovation.used) return std::nullopt;
        return innovation.nis;
      });
    });
  }

  std::optional<Fit> fit(const Estimate& estimate, const sensors::Observation& observation) const override {
    return with(estimate, [&](const auto& kernel, const auto& own) {
      return through_sensor(kernel, own, observation, [&](const auto& sensor, const auto& z) -> std::optional<Fit> {
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

  // Merges the explanations in one layout and only then checks whether the course is known.
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
  linear::Vector<2> velocity(const Estimate& estimate) const override {
    return with(estimate, [](const auto& kernel, const auto& own) { return kernel.velocity(own); });
  }

 private:
  // Converts the estimate to the kernel's layout once the course is known, and back when it is lost.
  void follow_course(Estimate& estimate) const {
    if constexpr (Kernel::kNeedsCourse) {
      if (const auto* young = std::get_if<linear::Gaussian<4>>(&estimate)) {
        if (has_course(*young)) estimate = kernel_.from(linear::Gaussian<4>(*young));
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

  // One function for both updates, for speed: with two copies the compiler would inline neither filter.
  template <class K, class Own>
  [[gnu::noinline]] void take_in(const K& kernel, Own& own, const sensors::Observation& observation) const {
    through_sensor(kernel, own, observation, [&](const auto& sensor, const auto& z) { kernel.update(sensor, z, own); });
  }

  // Calls the body with the sensor's model and the measurement. Positions are already in the tracks' axes
  // (fusion/sensors/known_sensor.h).
  template <class K, class Own, class Body>
  auto through_sensor(const K& kernel, const Own& own, const sensors::Observation& o, const Body& body) const {
    if (o.kind == sensors::ObservationKind::kPosition)
      return body(sensors::Position{},
                  sensors::Measurement<2>{o.z.template head<2>(), o.r.template topLeftCorner<2, 2>()});
    sensors::Measurement<3> z{o.z, o.r};
    if (std::isfinite(o.rate_span))
      doubt_rate(z, o.rate_span, z.z(1) + o.from.yaw, kernel.cartesian(own).p.template block<2, 2>(2, 2));
    const sensors::RangeBearingRate radar{o.rate_span};
    if (!at_the_origin(o.from)) return body(sensors::Mounted<sensors::RangeBearingRate>(o.from, radar), z);
    return body(radar, z);
  }

  Kernel kernel_;
  double velocity_variance_;
  Single<F, motion::ConstantVelocity> young_;
};

}  // namespace ttf::fusion::estimators
