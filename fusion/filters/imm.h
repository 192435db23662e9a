// Interacting multiple models (IMM): the object obeys one of several motion models at a time and switches
// between them as a Markov chain. (Blom, Bar-Shalom: "The interacting multiple model algorithm for systems with
// Markovian switching coefficients", IEEE TAC 33(8), 1988; Bar-Shalom, Li, Kirubarajan 2001, 11.6.6.) With mode
// probabilities mu and transitions p_ij:
//   mixing      c_j = sum_i p_ij mu_i,  mu_i|j = p_ij mu_i / c_j,  mode j starts from the mixture with weights mu_i|j;
//   prediction and update of each mode by itself;
//   mu_j <- c_j L_j / sum, L the likelihood of the innovation, all in logarithms.
// A probability below the smallest number becomes zero. It stays zero until the chain leads back to its mode;
// the sum stays 1 after every measurement.
//
// Modes may have different layouts, so there is no common state. Each mode mixes in its own layout, with the
// other estimates converted to it (motion/conversion.h). The result is the mixture of all modes in
// (x, y, vx, vy, ax, ay).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "fusion/filters/correct.h"
#include "fusion/filters/merge.h"
#include "fusion/filters/modes.h"
#include "fusion/motion/conversion.h"

namespace ttf::fusion::filters {

// The Markov chain of the modes. After `seconds` on average it draws a new mode, mode j with probability
// share(j):
//   P(dt) = e I + (1 - e) 1 share',  e = exp(-dt / seconds).
// P(a) P(b) = P(a + b) holds: asynchronous sensors see the same chain, and no time means no change.
template <int K> struct ModeChain {
  linear::Vector<K> share = linear::Vector<K>::Constant(1.0 / K);  // positive, with sum 1
  double seconds = 5.0;                                            // above 0

  linear::Matrix<K> transition(double dt) const {
    const double kept = std::exp(-dt / seconds);
    linear::Matrix<K> p = (1.0 - kept) * linear::Vector<K>::Ones() * share.transpose();
    p.diagonal().array() += kept;
    return p;
  }
};

template <class F, motion::Model... Ms> class Imm {
 public:
  static constexpr int kModes = static_cast<int>(sizeof...(Ms));

  explicit Imm(const ModeChain<kModes>& chain, const Ms&... models) : chain_(chain), models_(models...) {}

  void predict(Modes<Ms...>& modes, double dt) const {
    mix(modes, chain_.transition(dt));
    each([&]<std::size_t J>() { filter_.predict(std::get<J>(models_), std::get<J>(modes.estimates), dt); });
  }

  // Mixes the modes; p_ij is in row i, and each row has sum 1. A mode with probability zero before and after
  // keeps its estimate.
  void mix(Modes<Ms...>& modes, const linear::Matrix<kModes>& transition) const {
    const linear::Vector<kModes> c = transition.transpose() * modes.probability;
    const auto before = modes.estimates;
    each([&]<std::size_t J>() {
      const int j = static_cast<int>(J);
      if (c(j) <= 0.0) return;
      const linear::Vector<kModes> weights = transition.col(j).cwiseProduct(modes.probability) / c(j);
      mix_one<J>(before, weights, std::get<J>(modes.estimates));
    });
    modes.probability = c;
  }

  // Returns the innovation of the mixture: mean and covariance of the modes' predictions. It is used if every
  // mode can use it.
  template <sensors::Model S>
  Innovation<S::kDimension> innovate(const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                     const Modes<Ms...>& modes) const {
    Innovations<S::kDimension> of;
    each([&]<std::size_t J>() {
      of[J] = filter_.innovate(std::get<J>(models_), sensor, z, std::get<J>(modes.estimates));
    });
    if (!all_used<S::kDimension>(of)) return {};
    return mixture(sensor, of, modes.probability);
  }

  template <sensors::Model S>
  Innovation<S::kDimension> update(const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                   Modes<Ms...>& modes) const {
    auto after = modes.estimates;
    Innovations<S::kDimension> of;
    each([&]<std::size_t J>() { of[J] = filter_.update(std::get<J>(models_), sensor, z, std::get<J>(after)); });
    if (!all_used<S::kDimension>(of)) return {};
    modes.estimates = after;
    linear::Vector<kModes> log_weight;
    for (int j = 0; j < kModes; ++j)
      log_weight(j) = of[static_cast<std::size_t>(j)].log_likelihood() + std::log(modes.probability(j));
    const Innovation<S::kDimension> mixed = mixture(sensor, of, modes.probability);
    // Takes each exponential alone: Eigen's vectorised exponential ends at 1e-309. log 0 is -infinity, and exp
    // makes it 0.
    const double most = log_weight.maxCoeff();
    for (int j = 0; j < kModes; ++j) modes.probability(j) = std::exp(log_weight(j) - most);
    modes.probability /= modes.probability.sum();
    return mixed;
  }

  // Merges two estimates mode by mode (merge.h); each mode's weight is its probability in that estimate.
  void merge(Modes<Ms...>& first, double a, const Modes<Ms...>& second, double b) const {
    each([&]<std::size_t J>() {
      using M = std::tuple_element_t<J, std::tuple<Ms...>>;
      const int j = static_cast<int>(J);
      const double in_first = a * first.probability(j), in_second = b * second.probability(j);
      filters::merge<M>(std::get<J>(first.estimates), in_first, std::get<J>(second.estimates), in_second);
    });
    first.probability = (a * first.probability + b * second.probability) / (a + b);
  }

  // Returns the velocity of whole(), to the bit.
  linear::Vector<2> velocity(const Modes<Ms...>& modes) const {
    linear::Vector<2> mixed = linear::Vector<2>::Zero();
    each([&]<std::size_t J>() {
      using M = std::tuple_element_t<J, std::tuple<Ms...>>;
      const linear::Vector<2> of =
          M::template kinematics<motion::kWithVelocity>(std::get<J>(modes.estimates).x).velocity;
      motion::add_scaled<2, 1>(mixed, modes.probability(static_cast<int>(J)), of);
    });
    return mixed;
  }

  // Returns mean and covariance of (x, y, vx, vy, ax, ay) over all modes; unknown accelerations count as zero.
  linear::Gaussian<6> whole(const Modes<Ms...>& modes) const {
    std::array<linear::Gaussian<6>, static_cast<std::size_t>(kModes)> of;
    each([&]<std::size_t J>() {
      using M = std::tuple_element_t<J, std::tuple<Ms...>>;
      of[J] = motion::whole<M>(std::get<J>(modes.estimates)).estimate;
    });
    linear::Gaussian<6> mixed;
    for (std::size_t j = 0; j < of.size(); ++j)
      motion::add_scaled<6, 1>(mixed.x, modes.probability(static_cast<int>(j)), of[j].x);
    for (std::size_t j = 0; j < of.size(); ++j) {
      motion::add_scaled<6, 6>(mixed.p, modes.probability(static_cast<int>(j)), of[j].p);
      motion::add_outer<6>(mixed.p, modes.probability(static_cast<int>(j)), of[j].x - mixed.x);
    }
    return mixed;
  }

 private:
  template <int M> using Innovations = std::array<Innovation<M>, static_cast<std::size_t>(kModes)>;

  template <int M> static bool all_used(const Innovations<M>& of) {
    return std::all_of(of.begin(), of.end(), [](const Innovation<M>& one) { return one.used; });
  }

  template <class Body> static void each(const Body& body) {
    [&]<std::size_t... J>(std::index_sequence<J...>) { (body.template operator()<J>(), ...); }
    (std::index_sequence_for<Ms...>{});
  }

  // Works on differences from the most probable mode's innovation, so that angles average as angles.
  template <sensors::Model S, int M = S::kDimension>
  static Innovation<M> mixture(const S& sensor, const std::array<Innovation<M>, static_cast<std::size_t>(kModes)>& of,
                               const linear::Vector<kModes>& probability) {
    int likely = 0;
    probability.maxCoeff(&likely);
    const linear::Vector<M>& about = of[static_cast<std::size_t>(likely)].nu;
    std::array<linear::Vector<M>, static_cast<std::size_t>(kModes)> d;
    linear::Vector<M> shift = linear::Vector<M>::Zero();
    for (std::size_t j = 0; j < d.size(); ++j) {
      d[j] = sensor.residual(of[j].nu, about);
      motion::add_scaled<M, 1>(shift, probability(static_cast<int>(j)), d[j]);
    }
    Innovation<M> mixed;
    mixed.nu = sensor.residual(about + shift, linear::Vector<M>::Zero());
    mixed.s.setZero();
    for (std::size_t j = 0; j < d.size(); ++j) {
      motion::add_scaled<M, M>(mixed.s, probability(static_cast<int>(j)), of[j].s);
      motion::add_outer<M>(mixed.s, probability(static_cast<int>(j)), d[j] - shift);
    }
    const Ldl<M> ldl(mixed.s);
    mixed.nis = ldl.norm_squared(mixed.nu);
    mixed.determinant = ldl.determinant();
    mixed.used = true;
    return mixed;
  }

  template <std::size_t J>
  static void mix_one(const std::tuple<linear::Gaussian<Ms::kStates>...>& before, const linear::Vector<kModes>& weights,
                      linear::Gaussian<std::tuple_element_t<J, std::tuple<Ms...>>::kStates>& mixed) {
    using To = std::tuple_element_t<J, std::tuple<Ms...>>;
    constexpr int kN = To::kStates;
    const linear::Gaussian<kN> own = std::get<J>(before);
    std::array<linear::Gaussian<kN>, static_cast<std::size_t>(kModes)> in_own;
    linear::Vector<kN> shift = linear::Vector<kN>::Zero();  // from this mode's own mean to the mean
    each([&]<std::size_t I>() {
      using From = std::tuple_element_t<I, std::tuple<Ms...>>;
      const double weight = weights(static_cast<int>(I));
      if (weight == 0.0) return;
      in_own[I] = motion::converted<From, To>(std::get<I>(before), own);
      motion::add_scaled<kN, 1>(shift, weight, To::difference(in_own[I].x, own.x));
    });
    mixed.x = own.x + shift;
    To::normalise(mixed.x);
    mixed.p.setZero();
    each([&]<std::size_t I>() {
      const double weight = weights(static_cast<int>(I));
      if (weight == 0.0) return;
      motion::add_scaled<kN, kN>(mixed.p, weight, in_own[I].p);
      motion::add_outer<kN>(mixed.p, weight, To::difference(in_own[I].x, mixed.x));
    });
  }

  [[no_unique_address]] F filter_{};
  ModeChain<kModes> chain_;
  std::tuple<Ms...> models_;
};

}  // namespace ttf::fusion::filters
