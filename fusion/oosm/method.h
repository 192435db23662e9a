// Measurements out of sequence, on the level of one Gaussian state: what every method does, and how one is told from
// another. A late measurement is one whose stamp lies before what was taken already.
//
// Order of measurements, everywhere: (time, sensor, sequence). A start lies before all measurements of its instant.
// Model: x(t + dt) = F(dt) x(t) + w, w ~ N(0, Q(dt)), z = H x + v, v ~ N(0, R); all noises independent.
//
// Laws, which the tests carry in their names:
//  L1 InOrder     a stamp after all that were taken is kInOrder. While nothing is late and nothing was announced,
//                 state() is bit for bit what predict() and correct() (fusion/oosm/correction.h) give, one step
//                 from stamp to stamp.
//  L2 Newest      state() is the estimate at time(), the time of the newest stamp taken (or of the start): a late
//                 measurement moves neither backwards.
//  L3 Refused     what is not taken (kTooOld, kDuplicate, kUnannounced) changes no bit of what the method says,
//                 then or later.
//  L4 Gains       a late measurement that is taken never adds uncertainty: P+ <= P, and P+ stays symmetric to the
//                 bit and positive semi-definite, both up to rounding: no eigenvalue of P - P+ or P+ is below
//                 -1e-13 |P|, for R down to 1e-8 of the variance of what is measured.
//  L5 Value       a copy goes its own way: the same measurements give the same bits, and the original knows nothing
//                 of it.
//  L6 NoHeap      nothing allocates. Histories are of a fixed capacity; when one is full the oldest entry is
//                 forgotten.
//  L7 Start       start() forgets everything but the motion.
//  L8 Exact       a method gives, up to rounding, the estimate of processing in order whatever it took, within what
//                 kExactness says.
//  L9 Sight       at(stamp) is what a measurement of this stamp is an innovation to: there exactly where take() would
//                 take one, changing nothing; of a later stamp the prediction, of a late one the state of then as the
//                 method believes it, given all that was taken (rewinding: given all before it).
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
  constexpr auto operator<=>(const Stamp&) const = default;

 private:
  constexpr explicit Stamp(GlobalTime time) : time_(time) {}

  GlobalTime time_{};
  std::int64_t order_ = -1;  // among stamps of one time
};

enum class Taken : std::uint8_t {
  kInOrder = 1,
  kLate = 2,         // taken in behind what was there
  kTooOld = 3,       // older than what the method remembers: not taken
  kDuplicate = 4,    // a stamp the method remembers: not taken again
  kUnannounced = 5,  // late, and of an instant the method was not told of in time: not taken
};

// What is exact besides processing in order. Motions that compose (below) provided.
enum class Exactness : std::uint8_t {
  kApproximate = 0,
  kOneLate = 1,  // one late measurement, after what is measured in order and before the next late one
  kAlways = 2,   // everything that is taken, in any order of arrival
};

// F(dt) and Q(dt) of a step of dt > 0 seconds. Methods that look into the middle of a step are as exact as the motion
// composes: F(a + b) = F(b) F(a), Q(a + b) = F(b) Q(a) F(b)' + Q(b), which discretised white noise in continuous
// time does, and noise that is constant within every step does not. Rewinding needs no such thing.
template <class X, int N>
concept Motion = std::copyable<X> && requires(const X& motion, double dt) {
  { motion.step(dt) } -> std::same_as<linear::LinearStep<N>>;
};

// announce() says beforehand that a measurement of this stamp will come, late perhaps; it is false if the method
// can do nothing with that any more. Methods that need no such word take it and do nothing.
template <class X>
concept Method = std::copyable<X> &&
    requires(X x, const X& told, GlobalTime time, const Stamp& stamp, const linear::Gaussian<X::kStates>& prior,
             const linear::LinearMeasurement<X::kStates, X::kDimension>& measurement) {
  { X::kExactness } -> std::convertible_to<Exactness>;
  x.start(time, prior);
  { x.announce(stamp) } -> std::same_as<bool>;
  { x.take(stamp, measurement) } -> std::same_as<Taken>;
  { told.at(stamp) } -> std::same_as<std::optional<linear::Gaussian<X::kStates>>>;
  { told.state() } -> std::same_as<const linear::Gaussian<X::kStates>&>;
  { told.time() } -> std::same_as<GlobalTime>;
};

// Over `elapsed`, which may be nothing.
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
