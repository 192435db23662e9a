// The adjoint (Bryson-Frazier) pass gathers the information about x(tau) from all later innovations, backwards
// from the newest update to the first after tau. It needs no inverse of F or P (Bryson, Frazier: "Smoothing for
// Linear and Nonlinear Dynamic Systems", 1963; here with the cross-covariance to the newest instant).
//
// xb, Pb are the last estimate not after tau, predicted to tau. The pass starts with r = 0, L = 0, Phi = I and
// runs from i = k down to the first update after tau, with M(i) = I - K H:
//   r <- H' S^-1 nu + M' r,  L <- H' S^-1 H + M' L M,  then over the step before it, F(i):  r <- F' r,  L <- F' L F,
//   Phi <- Phi M F;     x(tau) = xb + Pb r,  P(tau) = Pb - Pb L Pb,  cov(x(k), x(tau)) = Phi Pb.
// Exact       one late measurement, at any lag. Gains and innovations before t(k) do not contain that measurement, so they
//             are useless for another one. After each late measurement the history restarts at t(k), and older stamps
//             are too old. So every measurement that is taken is exact.
// Stores      stamp, x, P, F, M, H' S^-1 nu, H' S^-1 H of every measurement in order since, within the capacity.
// Costs       some seven products of n x n per lag, and some in order to store them.
#pragma once

#include <optional>

#include "fusion/oosm/correction.h"
#include "fusion/oosm/history.h"
#include "fusion/oosm/method.h"
#include "fusion/oosm/retrodiction.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity> class Adjoint {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kOneLate;

  explicit Adjoint(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) { begin(Stamp::start(time), prior); }
  bool announce(const Stamp&) { return true; }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
             const Displacement<N>* displacement = nullptr) {
    const int n = history_.not_after(stamp);
    if (n == 0) return Taken::kTooOld;
    if (history_[n - 1].stamp == stamp) return Taken::kDuplicate;
    if (n == history_.size()) {
      step_in_order(stamp, measurement, displacement);
      return Taken::kInOrder;
    }
    linear::Gaussian<N> now = state();
    Retrodicted<N> then = retrodicted(stamp.time(), n);
    if (displacement != nullptr) displace<N>(now, then, *displacement);
    fuse_retrodicted<N, M>(now, then, measurement);
    begin(Stamp{history_.newest().stamp}, now);
    return Taken::kLate;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    const int n = history_.not_after(stamp);
    if (n == 0 || history_[n - 1].stamp == stamp) return std::nullopt;
    if (n == history_.size()) return advanced<N>(state(), motion_, stamp.time() - time());
    return retrodicted(stamp.time(), n).then;
  }

  const linear::Gaussian<N>& state() const { return history_.newest().estimate; }
  GlobalTime time() const { return history_.newest().stamp.time(); }

 private:
  struct Entry {
    Stamp stamp;
    linear::Gaussian<N> estimate;   // after the update
    linear::Matrix<N> f;            // over the step before it
    linear::Matrix<N> kept;         // M = I - K H
    linear::Vector<N> pull;         // H' S^-1 nu
    linear::Matrix<N> information;  // H' S^-1 H
  };

  void begin(const Stamp& stamp, const linear::Gaussian<N>& estimate) {
    history_.clear();
    Entry& first = history_.append();
    first.stamp = stamp;
    first.estimate = estimate;
  }

  [[gnu::flatten]] void step_in_order(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
                                      const Displacement<N>* displacement) {
    linear::Gaussian<N> estimate = state();
    const Duration elapsed = stamp.time() - time();
    Entry& entry = history_.append();
    entry.stamp = stamp;
    entry.f = linear::Matrix<N>::Identity();
    if (elapsed > Duration{}) {
      const linear::LinearStep<N> step = motion_.step(elapsed.seconds());
      linear::predict<N>(estimate, step);
      entry.f = step.f;
    }
    if (displacement != nullptr) displacement->move(estimate);
    const Whitened<N, M> whitened = correct<N, M>(estimate, measurement);
    entry.estimate = estimate;
    entry.kept = linear::Matrix<N>::Identity() - whitened.v * whitened.h;
    entry.pull = whitened.h.transpose() * whitened.nu;
    entry.information = whitened.h.transpose() * whitened.h;
  }

  // Retrodicts to tau; `first` is the first entry after tau.
  [[gnu::flatten]] Retrodicted<N> retrodicted(GlobalTime tau, int first) const {
    linear::Vector<N> r = linear::Vector<N>::Zero();
    linear::Matrix<N> information = linear::Matrix<N>::Zero(), transition = linear::Matrix<N>::Identity();
    for (int i = history_.size() - 1; i >= first; --i) {
      const Entry& entry = history_[i];
      const linear::Matrix<N> f = i == first ? transition_between(tau, entry.stamp.time()) : entry.f;
      const linear::Matrix<N> over = entry.kept * f;
      r = (f.transpose() * entry.pull + over.transpose() * r).eval();
      const linear::Matrix<N> here = entry.information * f, later = information * over;
      information = f.transpose() * here + over.transpose() * later;
      transition = (transition * over).eval();
    }
    Retrodicted<N> result{history_[first - 1].estimate, linear::Matrix<N>::Zero()};
    advance<N>(result.then, motion_, tau - history_[first - 1].stamp.time());
    const linear::Matrix<N> prior = result.then.p;
    result.cross = transition * prior;
    result.then.x += prior * r;
    const linear::Matrix<N> explained = information * prior;
    result.then.p -= prior * explained;
    linear::symmetrise<N>(result.then.p);
    return result;
  }

  linear::Matrix<N> transition_between(GlobalTime from, GlobalTime to) const {
    return to > from ? motion_.step((to - from).seconds()).f : linear::Matrix<N>::Identity();
  }

  Model motion_;
  History<Entry, Capacity> history_;
};

}  // namespace ttf::fusion::oosm
