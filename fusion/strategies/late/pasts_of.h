// The pasts (fusion/strategies/late/pasts.h) of one motion, under every method.
#pragma once

#include <memory>
#include <vector>

#include "core/check.h"
#include "fusion/motion/motion_model.h"
#include "fusion/oosm/adjoint.h"
#include "fusion/oosm/al1.h"
#include "fusion/oosm/algorithm_a.h"
#include "fusion/oosm/algorithm_b.h"
#include "fusion/oosm/algorithm_c.h"
#include "fusion/oosm/augmented.h"
#include "fusion/oosm/bl1.h"
#include "fusion/oosm/clone.h"
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
  oosm::Taken take(std::size_t slot, const When& when, const sensors::Observation& position,
                   const estimators::Displacement* displacement) override {
    TTF_CHECK(position.kind == sensors::ObservationKind::kPosition, "observation of kind {}",
              static_cast<int>(position.kind));
    linear::LinearMeasurement<kN, 2> measurement;
    measurement.z = position.z.template head<2>();
    measurement.h = transition(when.after).template topRows<2>();
    measurement.r = position.r.template topLeftCorner<2, 2>();
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

template <motion::LinearModel M>
std::unique_ptr<Pasts> make_pasts_of(const M& motion, oosm::Kind kind, std::size_t slots) {
  constexpr int kN = M::kStates;
  using oosm::Kind;
  switch (kind) {
    case Kind::kAugmented: return std::make_unique<PastsOf<M, oosm::Augmented<kN, 2, M, kRemembered>>>(motion, slots);
    case Kind::kClone: return std::make_unique<PastsOf<M, oosm::Clone<kN, 2, M, kClones>>>(motion, slots);
    case Kind::kAdjoint: return std::make_unique<PastsOf<M, oosm::Adjoint<kN, 2, M, kRemembered>>>(motion, slots);
    case Kind::kAl1: return std::make_unique<PastsOf<M, oosm::Al1<kN, 2, M, kRemembered>>>(motion, slots);
    case Kind::kBl1: return std::make_unique<PastsOf<M, oosm::Bl1<kN, 2, M, kRemembered>>>(motion, slots);
    case Kind::kA: return std::make_unique<PastsOf<M, oosm::AlgorithmA<kN, 2, M>>>(motion, slots);
    case Kind::kB: return std::make_unique<PastsOf<M, oosm::AlgorithmB<kN, 2, M>>>(motion, slots);
    case Kind::kC: return std::make_unique<PastsOf<M, oosm::AlgorithmC<kN, 2, M>>>(motion, slots);
    case Kind::kRewind: break;
  }
  TTF_CHECK(false, "no past of single states under {}", oosm::name_of(kind));
}

}  // namespace ttf::fusion::strategies::late
