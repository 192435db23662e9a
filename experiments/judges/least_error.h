// A bound of the error that instants can reach, by branch and bound over the phases of measurements.
//
// A measurement is at best `least_age` old at its first use. Let each one be known that early: a filter that knows more
// has no larger error. So the error of any instants is not below that of their phases alone. A box of phases has a
// bound of its own (Sighting::within). The box with the least bound is halved at its longest side, a counted number of
// times. The least bound that is left holds for all phases.
//
// No instants have the ages of some boxes at first use. In their phases at least one measurement is used later than its
// least age allows, by one use or more. The bound of such a box is the least one over the measurement that is late.
#pragma once

#include <functional>
#include <vector>

#include "core/time.h"
#include "experiments/judges/periodic_error.h"

namespace ttf::experiments::judges {

struct Stream {
  double variance = 0.0;  // [m^2]
  Duration period{}, least_age{};
};

struct Possible {
  Duration every{};  // between uses; periods of the streams are multiples or divisors of it
  std::vector<Stream> streams;
  Duration held{};  // Round::held
  // False: no instants have ages at first use between these, by stream. None: all may be.
  std::function<bool(const std::vector<Duration>& youngest, const std::vector<Duration>& oldest)> attainable;
};

// `bounded` returns a bound for a round whose sightings are boxes. Ends when the bound is above `enough`.
double least_over_phases(const Possible& possible, const std::function<double(const Round&)>& bounded, double enough,
                         int most_boxes);

// Returns a bound of the mean error at uses for a round whose sightings are boxes. The spread follows from the longest
// box.
double bounded_mean_error(const Round& round, Motion motion, double density);

}  // namespace ttf::experiments::judges
