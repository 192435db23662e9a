// The pasts (fusion/strategies/late/pasts.h) of one motion, under every method.
//
// Where a sensor measures ranges, measurements have three components. Range, bearing and range rate are linearised at the state
// to which they are an innovation:  H = J F(after),  z = H x + (z' - h(F(after) x)).  A position then has a third component
// that depends on nothing.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/check.h"
#include "fusion/estimators/doubtful_rate.h"
#include "fusion/motion/motion_model.h"
#include "fusion/oosm/adjoint.h"
#include "fusion/oosm/al1.h"
#include "fusion/oosm/algorithm_a.h"
#include "fusion/oosm/algorithm_b.h"
#include "fusion/oosm/algorithm_c.h"
#include "fusion/oosm/augmented.h"
#include "fusion/oosm/bl1.h"
#include "fusion/oosm/clone.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "fusion/strategies/late/pasts.h"

namespace ttf::fusion::strategies::late {

template <motion::LinearModel M, oosm::Method X> class PastsOf final : public Pasts {
 public:
  PastsOf(const M& motion, std::size_t slots) : motion_(motion), methods_(slots, X(motion)) {}

  void start(std::size_t slot, GlobalTime time, const estimators::Estimate& estimate) override {
    methods_[slot].start(time, std::get<State>(estimate));
  }
  void announce(std::size_t slot, const oosm::Stamp& stamp) override { methods_[slot].announce(stamp); }
  std::optional<estimators::Estimate> at(std::size_t slot, const When& when) const override {
    const std::optional<State> then = methods_[slot].at(when.stamp);
    if (!then) return std::nullopt;
    return moved(*then, when.after);
  }
  oosm::Taken take(std::size_t slot, const When& when, const sensors::Observation& z,
                   const estimators::Displacement* displacement) override {
    Measurement measurement;
    if (z.kind == sensors::ObservationKind::kPosition) {
      measurement.z.template head<2>() = z.z.template head<2>();
      measurement.h.template topRows<2>() = transition(when.after).template topRows<2>();
      measurement.r.template topLeftCorner<2, 2>() = z.r.template topLeftCorner<2, 2>();
    } else {
      measurement = linearised(slot, when, z, displacement);
    }
    if (displacement == nullptr) return methods_[slot].take(when.stamp, measurement);
    oosm::Displacement<kN> of_state;
    of_state.by.template head<2>() = displacement->by;
    of_state.spread.template topLeftCorner<2, 2>() = displacement->spread;
    return methods_[slot].take(when.stamp, measurement, &of_state);
  }
  estimators::Estimate newest(std::size_t slot, GlobalTime time) const override {
    const Duration elapsed = time - methods_[slot].time();
    if (elapsed < Duration{}) return moved(methods_[slot].state(), elapsed);  // the instant of a fast clock
    return oosm::advanced<kN>(methods_[slot].state(), motion_, elapsed);
  }

 private:
  static constexpr int kN = M::kStates;
  using State = linear::Gaussian<kN>;
  using Measurement = linear::LinearMeasurement<kN, X::kDimension>;

  // Says nothing where the method would refuse the measurement, or the sensor has no derivative.
  Measurement linearised(std::size_t slot, const When& when, const sensors::Observation& z,
                         const estimators::Displacement* displacement) const {
    Measurement measurement;
    if constexpr (X::kDimension == 3) {
      std::optional<State> at = methods_[slot].at(when.stamp);
      if (!at) return measurement;
      if (displacement != nullptr) at->x.template head<2>() += displacement->by;
      const linear::Matrix<kN> f = transition(when.after);
      const linear::Vector<kN> then = f * at->x;
      const motion::Kinematics k = M::template kinematics<motion::kWithVelocity>(then);
      const sensors::Mounted<sensors::RangeBearingRate> sensor(z.from, {z.rate_span});
      if (!sensor.sees(k)) return measurement;
      linear::Matrix<3, kN> h = linear::Matrix<3, kN>::Zero();
      h.template leftCols<4>() = sensor.jacobian(k);
      sensors::Measurement<3> polar{z.z, z.r};
      if (std::isfinite(z.rate_span)) {
        const linear::Matrix<kN> p = f * at->p * f.transpose();
        estimators::doubt_rate(polar, z.rate_span, z.z(1) + z.from.yaw, p.template block<2, 2>(2, 2));
      }
      measurement.z = h * then + sensor.residual(z.z, sensor.expected(k));
      measurement.h = h * f;
      measurement.r = polar.r;
    } else {
      TTF_CHECK(false, "observation of kind {} where all are positions", static_cast<int>(z.kind));
    }
    return measurement;
  }

  linear::Matrix<kN> transition(Duration by) const {
    return motion_.jacobian(linear::Vector<kN>::Zero(), by.seconds());
  }
  // Moves a state by a clock's deviation, forwards or backwards, without noise.
  State moved(const State& state, Duration by) const {
    if (by == Duration{}) return state;
    const linear::Matrix<kN> f = transition(by);
    State result{f * state.x, f * state.p * f.transpose()};
    linear::symmetrise<kN>(result.p);
    return result;
  }

  M motion_;
  std::vector<X> methods_;
};

// D is the number of a measurement's components.
template <int D, motion::LinearModel M>
std::unique_ptr<Pasts> make_pasts_of(const M& motion, const config::TrackerConfig& config, std::size_t slots) {
  constexpr int kN = M::kStates;
  using oosm::Kind;
  switch (config.late) {
    case Kind::kAugmented: return std::make_unique<PastsOf<M, oosm::Augmented<kN, D, M, kRemembered>>>(motion, slots);
    case Kind::kClone: return std::make_unique<PastsOf<M, oosm::Clone<kN, D, M, kClones>>>(motion, slots);
    case Kind::kAdjoint: return std::make_unique<PastsOf<M, oosm::Adjoint<kN, D, M, kRemembered>>>(motion, slots);
    case Kind::kAl1: return std::make_unique<PastsOf<M, oosm::Al1<kN, D, M, kRemembered>>>(motion, slots);
    case Kind::kBl1: return std::make_unique<PastsOf<M, oosm::Bl1<kN, D, M, kRemembered>>>(motion, slots);
    case Kind::kA: return std::make_unique<PastsOf<M, oosm::AlgorithmA<kN, D, M>>>(motion, slots);
    case Kind::kB: return std::make_unique<PastsOf<M, oosm::AlgorithmB<kN, D, M>>>(motion, slots);
    case Kind::kC: return std::make_unique<PastsOf<M, oosm::AlgorithmC<kN, D, M>>>(motion, slots);
    case Kind::kRewind: break;
  }
  TTF_CHECK(false, "no past of single states under {}", oosm::name_of(config.late));
}

}  // namespace ttf::fusion::strategies::late
