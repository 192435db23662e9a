// Forward fixed-point clones. The schedule states the instants of all measurements. When time passes such an
// instant without the measurement, its state is cloned. Every later update corrects the clone, too (fixed-point
// smoothing, Meditch: "Stochastic Optimal Linear Estimation and Control", 1969). The measurement, when it
// comes, corrects clone and newest state together; then the clone is dropped.
//
// A clone's instant is announced by its stamp before any later measurement is taken; otherwise announce()
// returns false. A late measurement without a clone is refused as kUnannounced. It is kTooOld if its stamp is
// not after a clone that was dropped without its measurement because all clones were in use. A clone whose
// measurement never comes stays until it is dropped so. Only the newest stamp is remembered.
// Exact       everything that is taken, several clones at once, in any order of arrival, to rounding (the motion
//             composes). Announced instants split the steps of the motion, which rounds differently from one step.
// Stores      x, P; of every clone its mean, covariance, and cross-covariances to the newest state and the other
//             clones. No history.
// Costs       late: O(n^2 m) per clone and pair of clones, the same at every lag; in order O(n^3) per clone and
//             O(n^2 m) per pair.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "fusion/oosm/joint.h"
#include "fusion/oosm/method.h"

namespace ttf::fusion::oosm {

// Clones is the most clones at once, and the most announced instants that time has not passed.
template <int N, int M, Motion<N> Model, int Clones> class Clone {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kAlways;

  explicit Clone(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    joint_.start(prior);
    last_ = gone_ = Stamp::start(time);
    pending_ = 0;
  }

  // Returns false if the stamp is not after the newest taken one, or if too many are announced.
  bool announce(const Stamp& stamp) {
    if (stamp <= last_) return false;
    const auto end = announced_.begin() + pending_;
    const auto after = std::lower_bound(announced_.begin(), end, stamp);
    if (after != end && *after == stamp) return true;
    if (pending_ == Clones) return false;
    std::copy_backward(after, end, end + 1);
    *after = stamp;
    ++pending_;
    return true;
  }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
             const Displacement<N>* displacement = nullptr) {
    if (stamp > last_) {
      pass(stamp);
      move(stamp.time() - reached_);
      if (displacement != nullptr) joint_.displace(*displacement, [](int) { return false; });
      joint_.correct_now(measurement);
      last_ = stamp;
      return Taken::kInOrder;
    }
    if (stamp == last_) return Taken::kDuplicate;
    for (int i = 0; i < joint_.size(); ++i) {
      if (stamps_[place(i)] != stamp) continue;
      if (displacement != nullptr)
        joint_.displace(*displacement, [&](int slot) { return stamps_[place(slot)] >= stamp; });
      joint_.correct_slot(i, measurement);
      drop(i);
      return Taken::kLate;
    }
    return stamp <= gone_ ? Taken::kTooOld : Taken::kUnannounced;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    if (stamp > last_) return advanced<N>(state(), motion_, stamp.time() - last_.time());
    for (int i = 0; i < joint_.size(); ++i)
      if (stamps_[place(i)] == stamp) return joint_.kept(i);
    return std::nullopt;
  }

  const linear::Gaussian<N>& state() const { return joint_.now(); }
  GlobalTime time() const { return last_.time(); }

 private:
  static std::size_t place(int i) { return static_cast<std::size_t>(i); }

  void move(Duration elapsed) {
    if (elapsed > Duration{}) joint_.propagate(motion_.step(elapsed.seconds()));
  }

  // Clones the announced instants before `stamp`; `stamp` itself is about to be taken.
  void pass(const Stamp& stamp) {
    reached_ = last_.time();
    int i = 0;
    for (; i < pending_ && announced_[place(i)] <= stamp; ++i) {
      const Stamp& due = announced_[place(i)];
      if (due == stamp) continue;
      move(due.time() - reached_);
      reached_ = due.time();
      if (joint_.size() == Clones) drop_oldest();
      stamps_[place(joint_.keep())] = due;
    }
    std::copy(announced_.begin() + i, announced_.begin() + pending_, announced_.begin());
    pending_ -= i;
  }

  void drop_oldest() {
    int oldest = 0;
    for (int i = 1; i < joint_.size(); ++i)
      if (stamps_[place(i)] < stamps_[place(oldest)]) oldest = i;
    gone_ = std::max(gone_, stamps_[place(oldest)]);
    drop(oldest);
  }

  void drop(int slot) {
    joint_.drop(slot);
    stamps_[place(slot)] = stamps_[place(joint_.size())];
  }

  Model motion_;
  Joint<N, M, Clones> joint_;
  std::array<Stamp, Clones> stamps_{};     // by clone
  std::array<Stamp, Clones> announced_{};  // not passed yet, in order
  int pending_ = 0;
  Stamp last_, gone_;
  GlobalTime reached_{};  // by the motion, while a measurement is being taken
};

}  // namespace ttf::fusion::oosm
