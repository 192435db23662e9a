// The common part of Al1 and Bl1 (Bar-Shalom, Chen, Mallick: "One-Step Solution for the Multistep
// Out-of-Sequence-Measurement Problem in Tracking", IEEE TAES 40(1), 2004). They collapse all measurements
// after tau into one equivalent measurement of x(k). So a measurement of any age is taken in as if it were one
// lag late.
//
// With x(j), P(j) the last estimate not after tau, and x*, P* its prediction to t(k):
//   S*^-1 = P*^-1 - P*^-1 P P*^-1,  S*^-1 nu* = P*^-1 (x - x*);  cov(x(k), v) = Q - P* S*^-1 Q = P P*^-1 Q,
//   Al1: E v = Q S*^-1 nu*, cov(v) = Q - Q S*^-1 Q;  Bl1: E v = 0, cov(v) = Q.
// The code never forms the equivalent measurement and factors only P*. P* must be regular: with some noise, or
// with a prior without exact components.
#pragma once

#include <cstdint>
#include <optional>

#include "fusion/oosm/correction.h"
#include "fusion/oosm/history.h"
#include "fusion/oosm/method.h"
#include "fusion/oosm/retrodiction.h"

namespace ttf::fusion::oosm {

enum class Noise : std::uint8_t { kRetrodicted = 0, kIgnored = 1 };  // Al1, Bl1

// Retrodicts from t(k) to tau. `predicted` is (x*, P*), `step` goes from tau to t(k), with a noise of mean `by`.
template <int N>
[[gnu::flatten]] Retrodicted<N> retrodict_collapsed(const linear::Gaussian<N>& now,
                                                    const linear::Gaussian<N>& predicted,
                                                    const linear::LinearStep<N>& step, const linear::Vector<N>& by,
                                                    Noise noise) {
  const linear::Matrix<N> root = whitening<N>(predicted.p);
  const linear::Matrix<N> share = root.transpose() * (root * step.q);  // P*^-1 Q
  const linear::Matrix<N> cross = now.p * share;
  if (noise == Noise::kIgnored) return retrodict<N>(now, step.f, by, step.q, cross);
  const linear::Vector<N> mean = by + share.transpose() * (now.x - predicted.x);
  return retrodict<N>(now, step.f, mean, step.q - share.transpose() * step.q + share.transpose() * cross, cross);
}

// Remembers the stamps taken in order and forgets late ones.
template <int N, int M, Motion<N> Model, int Capacity, Noise kNoise> class Collapsed {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kApproximate;

  explicit Collapsed(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    history_.clear();
    history_.append() = {Stamp::start(time), prior, {}};
  }
  bool announce(const Stamp&) { return true; }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
             const Displacement<N>* displacement = nullptr) {
    const Stamp last = history_.newest().stamp;
    if (stamp > last) {
      linear::Gaussian<N> estimate = state();
      advance<N>(estimate, motion_, stamp.time() - last.time());
      if (displacement != nullptr) displacement->move(estimate);
      correct<N, M>(estimate, measurement);
      history_.append() = {stamp, estimate, displacement != nullptr ? *displacement : Displacement<N>{}};
      return Taken::kInOrder;
    }
    const int n = history_.not_after(stamp);
    if (n == 0) return Taken::kTooOld;
    const Entry& then = history_[n - 1];
    if (then.stamp == stamp) return Taken::kDuplicate;
    Retrodicted<N> retrodiction = retrodicted(stamp.time(), n - 1);
    if (displacement != nullptr) {
      history_[n].before += *displacement;
      for (int i = n; i + 1 < history_.size(); ++i) displacement->move(history_[i].estimate);
      displace<N>(history_.newest().estimate, retrodiction, *displacement);
    }
    fuse_retrodicted<N, M>(history_.newest().estimate, retrodiction, measurement);
    return Taken::kLate;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    const int n = history_.not_after(stamp);
    if (n == 0 || history_[n - 1].stamp == stamp) return std::nullopt;
    if (n == history_.size()) return advanced<N>(state(), motion_, stamp.time() - time());
    return retrodicted(stamp.time(), n - 1).then;
  }

  const linear::Gaussian<N>& state() const { return history_.newest().estimate; }
  GlobalTime time() const { return history_.newest().stamp.time(); }

 private:
  struct Entry {
    Stamp stamp;
    linear::Gaussian<N> estimate;  // before the next entry
    Displacement<N> before;        // the state moved so before this measurement
  };

  // Retrodicts to tau; `last` is the last entry not after tau. The motion keeps displacements: those since add up.
  Retrodicted<N> retrodicted(GlobalTime tau, int last) const {
    const Entry& then = history_[last];
    Displacement<N> since;
    for (int i = last + 1; i < history_.size(); ++i) since += history_[i].before;
    linear::Gaussian<N> predicted = advanced<N>(then.estimate, motion_, time() - then.stamp.time());
    since.move(predicted);
    const Duration lag = time() - tau;
    linear::LinearStep<N> step = lag > Duration{} ? motion_.step(lag.seconds()) : linear::LinearStep<N>{};
    step.q += since.spread;
    return retrodict_collapsed<N>(state(), predicted, step, since.by, kNoise);
  }

  Model motion_;
  History<Entry, Capacity> history_;
};

}  // namespace ttf::fusion::oosm
