// The augmented state estimates the newest state and those of the last instants together (fusion/oosm/joint.h).
// So a late measurement is an ordinary measurement of an earlier part of the joint state (Challa, Evans, Wang:
// "A Bayesian solution and its approximations to out-of-sequence measurement problems", Information Fusion
// 4(3), 2003; Koch, Govaers 2011).
//
// A late measurement between two instants adds an instant by Markov interpolation. The instant stays, because
// later measurements between the same two depend on it.
// Exact       everything that is taken, in any order of arrival, to rounding (the motion composes).
// Stores      the joint distribution of the newest and Capacity - 1 earlier instants: O(capacity^2 n^2).
// Costs       O(instants^2 n^2 m) for every update, late or not, at every lag; forgotten instants cost nothing.
#pragma once

#include <array>
#include <optional>

#include "fusion/oosm/joint.h"
#include "fusion/oosm/method.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity> class Augmented {
  static_assert(Capacity >= 2, "a start and one measurement");

 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kAlways;

  explicit Augmented(const Model& motion) : motion_(motion) {}

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    joint_.start(prior);
    last_ = Stamp::start(time);
  }
  bool announce(const Stamp&) { return true; }

  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement,
             const Displacement<N>* displacement = nullptr) {
    if (stamp > last_) {
      stamps_[place(joint_.keep())] = last_;
      forget();
      if (stamp.time() > last_.time()) joint_.propagate(motion_.step((stamp.time() - last_.time()).seconds()));
      if (displacement != nullptr) {
        stamps_[place(joint_.keep())] = stamp.before();
        forget();
        joint_.displace(*displacement, [](int) { return false; });
      }
      joint_.correct_now(measurement);
      last_ = stamp;
      return Taken::kInOrder;
    }
    if (stamp == last_) return Taken::kDuplicate;
    const Neighbours found = neighbours(stamp);
    if (found.before == kNone) return Taken::kTooOld;
    if (stamps_[place(found.before)] == stamp) return Taken::kDuplicate;
    int slot = joint_.insert(found.before, found.after, bridge_at(stamp.time(), found));
    stamps_[place(slot)] = stamp;
    if (displacement != nullptr) slot = displaced_copy(slot, stamp, *displacement);
    joint_.correct_slot(slot, measurement);
    forget();
    return Taken::kLate;
  }

  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    if (stamp > last_) return advanced<N>(state(), motion_, stamp.time() - last_.time());
    if (stamp == last_) return std::nullopt;
    const Neighbours found = neighbours(stamp);
    if (found.before == kNone || stamps_[place(found.before)] == stamp) return std::nullopt;
    return joint_.interpolated(found.before, found.after, bridge_at(stamp.time(), found));
  }

  const linear::Gaussian<N>& state() const { return joint_.now(); }
  GlobalTime time() const { return last_.time(); }

 private:
  using States = Joint<N, M, Capacity>;
  static constexpr int kNone = -2;

  struct Neighbours {
    int before = kNone;  // not after the stamp
    int after = States::kNow;
  };

  static std::size_t place(int slot) { return static_cast<std::size_t>(slot); }

  // Takes late stamps only: the newest state is after them.
  Neighbours neighbours(const Stamp& stamp) const {
    Neighbours found;
    for (int i = 0; i < joint_.size(); ++i) {
      const Stamp& here = stamps_[place(i)];
      if (here <= stamp) {
        if (found.before == kNone || here > stamps_[place(found.before)]) found.before = i;
      } else if (found.after == States::kNow || here < stamps_[place(found.after)]) {
        found.after = i;
      }
    }
    return found;
  }

  Bridge<N> bridge_at(GlobalTime tau, const Neighbours& found) const {
    const Duration first = tau - stamps_[place(found.before)].time();
    const Duration second = (found.after == States::kNow ? last_ : stamps_[place(found.after)]).time() - tau;
    Bridge<N> result;
    if (first == Duration{})
      result.a.setIdentity();
    else if (second == Duration{})
      result.b.setIdentity();
    else
      result = bridge<N>(motion_.step(first.seconds()), motion_.step(second.seconds()));
    return result;
  }

  // Leaves the slot's state to measurements before the stamp, and adds it displaced, with all later ones.
  int displaced_copy(int slot, const Stamp& stamp, const Displacement<N>& displacement) {
    stamps_[place(slot)] = stamp.before();
    forget();
    const Neighbours found = neighbours(stamp);
    Bridge<N> same;
    same.a.setIdentity();
    const int copy = joint_.insert(found.before, found.after, same);
    stamps_[place(copy)] = stamp;
    joint_.displace(displacement, [&](int i) { return stamps_[place(i)] >= stamp; });
    return copy;
  }

  // Keeps at most Capacity instants, the newest included: drops the oldest.
  void forget() {
    if (joint_.size() < Capacity) return;
    int oldest = 0;
    for (int i = 1; i < joint_.size(); ++i)
      if (stamps_[place(i)] < stamps_[place(oldest)]) oldest = i;
    joint_.drop(oldest);
    stamps_[place(oldest)] = stamps_[place(joint_.size())];
  }

  Model motion_;
  States joint_;
  std::array<Stamp, Capacity> stamps_{};  // by slot
  Stamp last_;
};

}  // namespace ttf::fusion::oosm
