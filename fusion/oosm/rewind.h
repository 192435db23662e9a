// Rewind and reprocess: back to the last estimate before the late measurement, then everything again from there.
//
// Exact       whatever is taken, and bit for bit what processing in order gives, whatever the order of arrival: the
//             very same code sees the very same measurements in the same order. Of the motion it assumes nothing.
//             Where measurements are associated with what they are of, that can be thought over, too.
// Stores      stamp, measurement, x, P of every measurement within the capacity, late ones included. One that is
//             forgotten stays fused; what is older than the oldest remembered is too old.
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
    linear::LinearMeasurement<N, M> measurement;  // of a start: none
    linear::Gaussian<N> estimate;                 // after it
  };

  Model motion_;
  History<Entry, Capacity> history_;
};

}  // namespace ttf::fusion::oosm
