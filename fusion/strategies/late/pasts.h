// What a method for late measurements (fusion/oosm/) keeps of every object, each in a slot of its own: the wall between
// the tracks, which know neither state nor motion, and the methods, which know nothing of objects.
//
// Methods take positions of objects in straight motion: there everything is linear and Gaussian. An estimate is as an
// estimator makes it (fusion/estimators/estimate.h). Nothing allocates after construction.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimate.h"
#include "fusion/oosm/method.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::strategies::late {

inline constexpr int kRemembered = 16;  // measurements of an object that a method can reach behind, births included
inline constexpr int kClones = 8;       // of an object, at a time

// Measured `after` the stamp's instant, or before: by what a clock is off the schedule. A position of then is taken as
// H F(after) x + v of the instant's state. What noise does to the object meanwhile is left out: in position a variance
// of q after^3 / 3, and a covariance of q after^2 lag / 2 with where it is now; of 1 us a tenth of a second ago, at
// q = 3 m^2/s^3, 1e-18 m^2 and 1.5e-13 m^2.
struct When {
  oosm::Stamp stamp;
  Duration after{};
};

class Pasts {
 public:
  virtual ~Pasts() = default;
  // Forgets what the slot held: an object is believed to be at `estimate` at `time`.
  virtual void start(std::size_t slot, GlobalTime time, const estimators::Estimate& estimate) = 0;
  virtual void announce(std::size_t slot, const oosm::Stamp& stamp) = 0;
  // What a position measured then is an innovation to (law L9 of fusion/oosm/method.h); nothing where take() would not
  // take it.
  virtual std::optional<estimators::Estimate> at(std::size_t slot, const When& when) const = 0;
  virtual oosm::Taken take(std::size_t slot, const When& when, const sensors::Observation& position) = 0;
  // Predicted to `time`.
  virtual estimators::Estimate newest(std::size_t slot, GlobalTime time) const = 0;
};

// For straight motion, config.late, and so many objects. What a slot takes: fusion/strategies/late/late_updates.h.
std::unique_ptr<Pasts> make_pasts(const config::TrackerConfig& config, std::size_t slots);
// Of one motion. One source file each: the compiler takes its time over them.
std::unique_ptr<Pasts> make_at_constant_velocity(const config::TrackerConfig& config, std::size_t slots);
std::unique_ptr<Pasts> make_at_constant_acceleration(const config::TrackerConfig& config, std::size_t slots);

}  // namespace ttf::fusion::strategies::late
