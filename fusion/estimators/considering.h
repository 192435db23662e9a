// The estimator that considers the sensors' biases (fusion/filters/consider.h). Objects move in straight lines
// under the extended filter, and each object keeps its correlation with all biases.
//
// An object starts from an observation with the error D b + v (fusion/sensors/among_biases.h). The first
// estimate, J times the measurement, has the error J (D b + v). So at the start cov(x, b) = -J D B, and the
// covariance contains J D B D' J' beside the noise. Later observations of that sensor have the same b, and the
// filter accounts for it.
//
// The time stamp's error moves an object by v tau. The filter treats v as known there. The uncertainty of v
// adds var(v) var(tau) to the measurement's noise, to second order: much for a new object, little later.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/check.h"
#include "fusion/estimators/model_estimator.h"
#include "fusion/filters/consider.h"
#include "fusion/filters/merge.h"
#include "fusion/sensors/among_biases.h"

namespace ttf::fusion::estimators {

// The biases of all sensors in one row: those with a sigma above zero, ordered by SensorId, then by component.
class AllBiases {
 public:
  explicit AllBiases(std::span<const sensors::KnownSensor> sensors);

  const sensors::OwnBiases& of(SensorId id) const { return index_of(id) < own_.size() ? own_[index_of(id)] : nobodys_; }
  const linear::Matrix<sensors::kMostBiases>& covariance() const { return covariance_; }

 private:
  std::vector<sensors::OwnBiases> own_;
  sensors::OwnBiases nobodys_;
  linear::Matrix<sensors::kMostBiases> covariance_ = linear::Matrix<sensors::kMostBiases>::Zero();
};

// Returns d (x, y, vx, vy) / d measurement of first_estimate(), in the tracks' axes.
linear::Matrix<4, 3> first_jacobian(const sensors::Observation& observation);

template <motion::Model M>
requires(M::kCartesian) class ConsideringEstimator final : public Estimator {
 public:
  static constexpr int kN = M::kStates;
  using Own = WithBiases<kN>;

  ConsideringEstimator(const config::TrackerConfig& config, const M& model, const linear::Gaussian<kN>& prior)
      : model_(model), prior_(prior), biases_(config.sensors), filter_{.bias = biases_.covariance()},
        velocity_variance_(config.initial_velocity_sigma * config.initial_velocity_sigma) {}

  Estimate initial(const sensors::Observation& observation) const override {
    const sensors::Observation o = as_first(observation, velocity_variance_);
    const linear::Gaussian<4> first = first_estimate(o, velocity_variance_);
    const sensors::OwnBiases& biases = biases_.of(o.sensor);
    Own own{.state = prior_};
    own.state.x.template head<4>() = first.x;
    own.state.p.template topLeftCorner<4, 4>() = first.p;
    own.state.p.template topLeftCorner<2, 2>() += biases.time_variance * first.p.bottomRightCorner<2, 2>();
    const motion::Kinematics k{.position = first.x.head<2>(), .velocity = first.x.tail<2>()};
    through_sensor(o, [&](const auto& sensor, const auto&) {
      constexpr int kM = std::remove_cvref_t<decltype(sensor)>::kDimension;
      if (!sensor.sees(k)) return;
      const linear::Matrix<4, kM> j = first_jacobian(o).template leftCols<kM>();
      const linear::Matrix<4, sensors::kMostBiases> jd =
          motion::times<4, kM, sensors::kMostBiases>(j, sensor.bias_jacobian(k));
      own.cross.template topRows<4>() = -motion::times<4, sensors::kMostBiases, sensors::kMostBiases>(jd, filter_.bias);
      own.state.p.template topLeftCorner<4, 4>() += motion::sandwich<4, sensors::kMostBiases>(jd, filter_.bias);
    });
    return own;
  }

  void predict(Estimate& estimate, double dt) const override {
    TTF_CHECK(dt >= 0.0, "prediction by {} s", dt);
    if (dt > 0.0) filter_.predict(model_, own_of(estimate), dt);
  }

  std::optional<double> distance_squared(const Estimate& estimate, const sensors::Observation& o) const override {
    const Own& own = own_of(estimate);
    return through_sensor(o, [&](const auto& sensor, auto z) -> std::optional<double> {
      prepare(own, sensor, o, z);
      const auto innovation = filter_.innovate(model_, sensor, z, own);
      if (!innovation.used) return std::nullopt;
      return innovation.nis;
    });
  }

  std::optional<Fit> fit(const Estimate& estimate, const sensors::Observation& o) const override {
    const Own& own = own_of(estimate);
    return through_sensor(o, [&](const auto& sensor, auto z) -> std::optional<Fit> {
      prepare(own, sensor, o, z);
      const auto innovation = filter_.innovate(model_, sensor, z, own);
      if (!innovation.used) return std::nullopt;
      return Fit{innovation.nis, std::exp(innovation.log_likelihood())};
    });
  }

  void update(Estimate& estimate, const sensors::Observation& o) const override { take_in(own_of(estimate), o); }

  // Merges the explanations. The biases keep mean zero, so the mixture's correlation with them is the mean of
  // the explanations' correlations.
  void update(Estimate& estimate, std::span<const Explanation> explanations) const override {
    Own& own = own_of(estimate);
    const Own before = own;
    double weight = 0.0;
    for (const Explanation& explanation : explanations) {
      if (explanation.weight <= 0.0) continue;
      Own after = before;
      if (explanation.observation) take_in(after, *explanation.observation);
      const double share = explanation.weight / (weight + explanation.weight);
      if (weight > 0.0) {
        filters::merge<M>(own.state, weight, after.state, explanation.weight);
        own.cross += share * (after.cross - own.cross);
      } else {
        own = after;
      }
      weight += explanation.weight;
    }
  }

  linear::Gaussian<2> position(const Estimate& estimate) const override {
    const linear::Gaussian<kN>& state = own_of(estimate).state;
    return {state.x.template head<2>(), state.p.template topLeftCorner<2, 2>()};
  }
  Cartesian cartesian(const Estimate& estimate) const override {
    return motion::whole<M>(own_of(estimate).state).estimate;
  }
  linear::Vector<2> velocity(const Estimate& estimate) const override {
    return own_of(estimate).state.x.template segment<2>(2);
  }

  linear::Gaussian<2> seen_position(const Estimate& estimate, SensorId id,
                                    const sensors::Mounting& from) const override {
    const Own& own = own_of(estimate);
    const sensors::AmongBiases<sensors::Position> sensor{{}, biases_.of(id), from};
    sensors::Measurement<2> z{own.state.x.template head<2>(), linear::Matrix<2>::Zero()};
    blur(own, sensor, z);
    return {z.z, filter_.spread(model_, sensor, z, own)};
  }

 private:
  template <class E> static auto& own_of(E& estimate) {
    auto* own = std::get_if<Own>(&estimate);
    TTF_CHECK(own, "an estimate of another estimator: alternative {}", estimate.index());
    return *own;
  }

  void take_in(Own& own, const sensors::Observation& o) const {
    through_sensor(o, [&](const auto& sensor, auto z) {
      prepare(own, sensor, o, z);
      filter_.update(model_, sensor, z, own);
    });
  }

  template <class Body> auto through_sensor(const sensors::Observation& o, const Body& body) const {
    using sensors::AmongBiases, sensors::Measurement;
    const sensors::OwnBiases& own = biases_.of(o.sensor);
    if (o.kind == sensors::ObservationKind::kPosition)
      return body(sensors::AmongBiases<sensors::Position>{{}, own, o.from},
                  sensors::Measurement<2>{o.z.template head<2>(), o.r.template topLeftCorner<2, 2>()});
    using Radar = sensors::Mounted<sensors::RangeBearingRate>;
    return body(sensors::AmongBiases<Radar>{Radar(o.from, {o.rate_span}), own, o.from},
                sensors::Measurement<3>{o.z, o.r});
  }

  template <class S>
  static void prepare(const Own& own, const S& sensor, const sensors::Observation& o,
                      sensors::Measurement<S::kDimension>& z) {
    if constexpr (S::kDimension == 3)
      if (std::isfinite(o.rate_span))
        doubt_rate(z, o.rate_span, z.z(1) + o.from.yaw, own.state.p.template block<2, 2>(2, 2));
    blur(own, sensor, z);
  }

  // Adds the noise of the time stamp's error that comes from the uncertain velocity.
  template <class S> static void blur(const Own& own, const S& sensor, sensors::Measurement<S::kDimension>& z) {
    if (sensor.own.time_variance == 0.0) return;
    const motion::Kinematics k = M::template kinematics<motion::kWithVelocity>(own.state.x);
    if (!sensor.sees(k)) return;
    const linear::Matrix<S::kDimension, 2> by_position = sensor.sensor.jacobian(k).template leftCols<2>();
    const linear::Matrix<2> velocity = own.state.p.template block<2, 2>(2, 2);
    motion::add_scaled<S::kDimension, S::kDimension>(z.r, sensor.own.time_variance,
                                                     motion::sandwich<S::kDimension, 2>(by_position, velocity));
  }

  M model_;
  linear::Gaussian<kN> prior_;
  AllBiases biases_;
  filters::Consider<sensors::kMostBiases> filter_;
  double velocity_variance_;
};

}  // namespace ttf::fusion::estimators
