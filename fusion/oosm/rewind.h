// Rewind and reprocess: returns to the last estimate before the late measurement and processes everything from
// there again.
//
// Exact       everything that is taken, in any order of arrival, bit for bit as in order: the same code processes the
//             same measurements in the same order. It assumes nothing of the motion. Associations can be made
//             anew, too.
// Stores      stamp, measurement, x, P of every measurement within the capacity, late ones included. A forgotten
//             measurement stays fused; a stamp older than the oldest remembered is too old.
// Costs       l + 1 steps of predict and update at lag l.
#pragma once

#include <optional>

#include "fusion/oosm/correction.h"
#include "fusion/oosm/history.h"
#include "fusion/oosm/method.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity> class Rewind {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kAlways;

  explicit Rewind(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    history_.clear();
    Entry& first = history_.append();
    first.stamp = Stamp::start(time);
    first.estimate = prior;
  }
  bool announce(const Stamp&) { return true; }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement) {
    const int n = history_.not_after(stamp);
    if (n == 0) return Taken::kTooOld;
    const Entry& before = history_[n - 1];
    if (before.stamp == stamp) return Taken::kDuplicate;
    linear::Gaussian<N> estimate = before.estimate;  // `before` itself may be forgotten
    GlobalTime time = before.stamp.time();
    const bool late = n < history_.size();
    int at = n;
    if (late)
      at = history_.open(n);
    else {
      history_.append();
      at = history_.size() - 1;
    }
    history_[at].stamp = stamp;
    history_[at].measurement = measurement;
    for (; at < history_.size(); ++at) {
      Entry& entry = history_[at];
      advance<N>(estimate, motion_, entry.stamp.time() - time);
      correct<N, M>(estimate, entry.measurement);
      entry.estimate = estimate;
      time = entry.stamp.time();
    }
    return late ? Taken::kLate : Taken::kInOrder;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    const int n = history_.not_after(stamp);
    if (n == 0 || history_[n - 1].stamp == stamp) return std::nullopt;
    const Entry& before = history_[n - 1];
    return advanced<N>(before.estimate, motion_, stamp.time() - before.stamp.time());
  }

  const linear::Gaussian<N>& state() const { return history_.newest().estimate; }
  GlobalTime time() const { return history_.newest().stamp.time(); }

 private:
  struct Entry {
    Stamp stamp;
    linear::LinearMeasurement<N, M> measurement;  // unused for a start
    linear::Gaussian<N> estimate;                 // after the measurement
  };

  Model motion_;
  History<Entry, Capacity> history_;
};

}  // namespace ttf::fusion::oosm
