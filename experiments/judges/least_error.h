// A bound of the error that instants can reach, by branch and bound over the phases of measurements.
//
// A measurement is at best `least_age` old at its first use. Let each one be there that early: a filter with earlier
// data has no larger error. So the error of any instants is not below that of their phases alone. A box of phases has a
// bound of its own (trial_path.h). The box with the least bound is halved, a counted number of times, at the side whose
// length matters most: by the information of its stream. The least bound that is left holds for all phases.
//
// No instants have the ages of some boxes at first use. In their phases some measurements are used later than their
// least ages allow, by one use or more. The bound of such a box is the least one over the sets of measurements that may
// be late.
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

}  // namespace ttf::experiments::judges
