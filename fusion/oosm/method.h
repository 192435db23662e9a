// Methods for measurements out of sequence, for one Gaussian state: their common interface and their
// differences. A late measurement has a stamp before the newest taken one.
//
// The order of measurements is always (time, sensor, sequence). A start precedes all measurements of its
// instant. Model: x(t + dt) = F(dt) x(t) + w, w ~ N(0, Q(dt)), z = H x + v, v ~ N(0, R); all noises
// independent.
//
// Laws, which the tests carry in their names:
//  L1 InOrder     A stamp after all taken ones is kInOrder. Without late or announced stamps, state() is bit for bit
//                 the result of predict() and correct() (fusion/oosm/correction.h), one step from stamp to stamp.
//  L2 Newest      state() is the estimate at time(), the time of the newest taken stamp (or of the start). A late
//                 measurement moves neither backwards.
//  L3 Refused     A refused measurement (kTooOld, kDuplicate, kUnannounced) changes no bit of the method's results,
//                 then or later.
//  L4 Gains       A late measurement that is taken never adds uncertainty: P+ <= P. P+ stays symmetric to the bit and
//                 positive semi-definite. Both hold up to rounding: no eigenvalue of P - P+ or P+ is below -1e-13 |P|,
//                 for R down to 1e-8 of the variance of the measured quantity.
//  L5 Value       A copy is independent: the same measurements give it the same bits, and the original does not change.
//  L6 NoHeap      Methods never allocate. Histories have a fixed capacity; a full one forgets its oldest entry.
//  L7 Start       start() forgets everything except the motion.
//  L8 Exact       Within kExactness, after any measurements, the estimate is that of processing in order, up to
//                 rounding.
//  L9 Sight       at(stamp) returns the state to which a measurement of this stamp is an innovation. It has a value
//                 exactly if take() would take the measurement, and changes nothing. For a stamp after the newest it is
//                 the prediction. For a late one it is the method's estimate of that instant, given all taken
//                 measurements (for rewinding: given all earlier ones).
//  L10 Displaced  take() with a displacement d ~ N(by, spread) acts as if the states from this stamp on, up to the newest,
//                 were x + d, and earlier ones x. Measurements of earlier stamps are of x, later ones of x + d. d is
//                 independent of all else, and the motion keeps it, F d = d, as of a position in straight motion. All but
//                 rewinding can do so, as exactly as without; a late displacement is for augmented states and clones as
//                 exact as one in order, for others while it is the newest late measurement.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/linear/gaussian.h"

namespace ttf::fusion::oosm {

class Stamp {
 public:
  constexpr Stamp() = default;
  constexpr Stamp(GlobalTime measured, MeasurementId id)
      : time_(measured), order_((std::int64_t{static_cast<std::uint8_t>(id.sensor)} << 32) | id.sequence) {}
  static constexpr Stamp start(GlobalTime time) { return Stamp(time); }

  constexpr GlobalTime time() const { return time_; }
  // Returns the stamp just before this one: what was, before its measurement was taken.
  constexpr Stamp before() const {
    Stamp earlier = *this;
    --earlier.order_;
    return earlier;
  }
  constexpr auto operator<=>(const Stamp&) const = default;

 private:
  constexpr explicit Stamp(GlobalTime time) : time_(time) {}

  GlobalTime time_{};
  std::int64_t order_ = -1;  // among stamps of one time
};

enum class Taken : std::uint8_t {
  kInOrder = 1,
  kLate = 2,         // taken behind the newest
  kTooOld = 3,       // older than the method's memory: refused
  kDuplicate = 4,    // a stamp in the method's memory: refused
  kUnannounced = 5,  // late, and not announced in time: refused
};

// The displacement of a state, law L10.
template <int N> struct Displacement {
  linear::Vector<N> by = linear::Vector<N>::Zero();
  linear::Matrix<N> spread = linear::Matrix<N>::Zero();  // symmetric positive semi-definite

  void move(linear::Gaussian<N>& state) const {
    state.x += by;
    state.p += spread;
  }
  Displacement& operator+=(const Displacement& other) {
    by += other.by;
    spread += other.spread;
    return *this;
  }
};

// The measurements beside those in order that are exact, for motions that compose (below).
enum class Exactness : std::uint8_t {
  kApproximate = 0,
  kOneLate = 1,  // one late measurement, after those in order and before the next late one
  kAlways = 2,   // everything that is taken, in any order of arrival
};

// F(dt) and Q(dt) of a step of dt > 0 seconds. Methods that split a step are as exact as the motion composes:
// F(a + b) = F(b) F(a), Q(a + b) = F(b) Q(a) F(b)' + Q(b). Discretised white noise in continuous time composes;
// noise that is constant within a step does not. Rewinding needs no such property.
template <class X, int N>
concept Motion = std::copyable<X> && requires(const X& motion, double dt) {
  { motion.step(dt) } -> std::same_as<linear::LinearStep<N>>;
};

// announce() announces a measurement of this stamp, which may come late. It returns false if the method cannot
// use that any more. Methods that need no announcement return true and do nothing.
template <class X>
concept Method = std::copyable<X> &&
    requires(X x, const X& started, GlobalTime time, const Stamp& stamp, const linear::Gaussian<X::kStates>& prior,
             const linear::LinearMeasurement<X::kStates, X::kDimension>& measurement) {
  { X::kExactness } -> std::convertible_to<Exactness>;
  x.start(time, prior);
  { x.announce(stamp) } -> std::same_as<bool>;
  { x.take(stamp, measurement) } -> std::same_as<Taken>;
  { started.at(stamp) } -> std::same_as<std::optional<linear::Gaussian<X::kStates>>>;
  { started.state() } -> std::same_as<const linear::Gaussian<X::kStates>&>;
  { started.time() } -> std::same_as<GlobalTime>;
};

// Advances the state over `elapsed`, which may be zero.
template <int N, Motion<N> M>
[[gnu::flatten]] void advance(linear::Gaussian<N>& state, const M& motion, Duration elapsed) {
  if (elapsed > Duration{}) linear::predict<N>(state, motion.step(elapsed.seconds()));
}
template <int N, Motion<N> M>
linear::Gaussian<N> advanced(linear::Gaussian<N> state, const M& motion, Duration elapsed) {
  advance<N>(state, motion, elapsed);
  return state;
}

}  // namespace ttf::fusion::oosm
