// The common part of Algorithms A, B and C (Bar-Shalom: "Update with Out-of-Sequence Measurements in Tracking:
// Exact Solution", IEEE TAES 38(3), 2002). They go one measurement back, t(k-1) <= tau <= t(k), over the
// inverse of F from tau to t(k).
//
// They differ in their Memory of the last update:
//   corrected(predicted, whitened)        after the update by a measurement in order, from P- = `predicted`
//   retrodict(now, step)                  x(tau); step goes from tau to t(k)
//   booked(before, now)                   after a late measurement changed `before` to `now`, both at t(k)
#pragma once

#include <optional>

#include "fusion/oosm/correction.h"
#include "fusion/oosm/method.h"
#include "fusion/oosm/retrodiction.h"

namespace ttf::fusion::oosm {

// Remembers the last two stamps taken in order and forgets late ones.
template <int N, int M, Motion<N> Model, class Memory, Exactness kExact> class OneLag {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = kExact;

  explicit OneLag(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    before_last_ = last_ = Stamp::start(time);
    displaced_ = {};
    displaced_at_ = last_;
    state_ = prior;
  }
  bool announce(const Stamp&) { return true; }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
             const Displacement<N>* displacement = nullptr) {
    if (stamp > last_) {
      advance<N>(state_, motion_, stamp.time() - last_.time());
      displaced_ = {};
      displaced_at_ = last_;
      if (displacement != nullptr) note(*displacement, stamp);
      const linear::Matrix<N> predicted = state_.p;
      memory_.corrected(predicted, correct<N, M>(state_, measurement));
      before_last_ = last_;
      last_ = stamp;
      return Taken::kInOrder;
    }
    if (stamp == last_ || stamp == before_last_) return Taken::kDuplicate;
    if (stamp < before_last_) return Taken::kTooOld;
    Retrodicted<N> then = retrodicted(stamp);
    if (displacement != nullptr) {
      displace<N>(state_, then, *displacement);
      displaced_ += *displacement;
      displaced_at_ = stamp;
    }
    const linear::Gaussian<N> before = state_;
    fuse_retrodicted<N, M>(state_, then, measurement);
    memory_.booked(before, state_);
    return Taken::kLate;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    if (stamp > last_) return advanced<N>(state_, motion_, stamp.time() - last_.time());
    if (stamp <= before_last_ || stamp == last_) return std::nullopt;
    return retrodicted(stamp).then;
  }

  const linear::Gaussian<N>& state() const { return state_; }
  GlobalTime time() const { return last_.time(); }

 private:
  void note(const Displacement<N>& displacement, const Stamp& stamp) {
    displacement.move(state_);
    displaced_ = displacement;
    displaced_at_ = stamp;
  }
  // A displacement since is noise of the step, with a mean.
  Retrodicted<N> retrodicted(const Stamp& stamp) const {
    const Duration lag = last_.time() - stamp.time();
    linear::LinearStep<N> step = lag > Duration{} ? motion_.step(lag.seconds()) : linear::LinearStep<N>{};
    if (stamp >= displaced_at_) return memory_.retrodict(state_, step);
    step.q += displaced_.spread;
    return memory_.retrodict({state_.x - displaced_.by, state_.p}, step);
  }

  Model motion_;
  Stamp before_last_, last_;
  Displacement<N> displaced_;  // since before_last_, at this stamp
  Stamp displaced_at_;
  linear::Gaussian<N> state_;
  Memory memory_;
};

}  // namespace ttf::fusion::oosm
