// The pasts of all objects under a method for late measurements (fusion/oosm/), each in its own slot. This
// interface separates the tracks, which have neither state nor motion, from the methods, which have no objects.
//
// Methods take positions of objects in straight motion: there everything is linear and Gaussian. Ranges, bearings and range
// rates are linearised (fusion/strategies/late/pasts_of.h). Estimates have
// an estimator's layout (fusion/estimators/estimate.h). Nothing allocates after construction.
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

inline constexpr int kRemembered = 16;  // measurements of an object that a method can reach behind, birth included
inline constexpr int kClones = 8;       // an object's at a time

// The measurement happened `after` the stamp's instant, or before it if negative: the clock's deviation from
// the schedule. The position is taken as H F(after) x + v of the instant's state. The object's noise within
// `after` is neglected. It adds a position variance of q after^3 / 3 and a covariance of q after^2 lag / 2 with
// the present position. For 1 us and a lag of 0.1 s at q = 3 m^2/s^3 these are 1e-18 m^2 and 1.5e-13 m^2.
struct When {
  oosm::Stamp stamp;
  Duration after{};
};

class Pasts {
 public:
  virtual ~Pasts() = default;
  // Forgets the slot's content; the object starts with `estimate` at `time`.
  virtual void start(std::size_t slot, GlobalTime time, const estimators::Estimate& estimate) = 0;
  virtual void announce(std::size_t slot, const oosm::Stamp& stamp) = 0;
  // Returns the state that a position measured then is an innovation to (law L9 of fusion/oosm/method.h); no
  // value if take() would refuse it.
  virtual std::optional<estimators::Estimate> at(std::size_t slot, const When& when) const = 0;
  // `displacement`: the anchor has moved so, and this is the first position of the new one (law L10); null: it has not.
  virtual oosm::Taken take(std::size_t slot, const When& when, const sensors::Observation& observation,
                           const estimators::Displacement* displacement = nullptr) = 0;
  // Returns the newest estimate, predicted to `time`.
  virtual estimators::Estimate newest(std::size_t slot, GlobalTime time) const = 0;
};

// Makes the pasts for straight motion and config.late; `ranges` says whether a sensor measures ranges. fusion/strategies/late/late_updates.h lists the memory of
// a slot.
std::unique_ptr<Pasts> make_pasts(const config::TrackerConfig& config, std::size_t slots, bool ranges = false);
// Make the pasts of one motion, each in its own source file: these templates compile slowly.
std::unique_ptr<Pasts> make_at_constant_velocity(const config::TrackerConfig& config, std::size_t slots);
std::unique_ptr<Pasts> make_at_constant_acceleration(const config::TrackerConfig& config, std::size_t slots);
std::unique_ptr<Pasts> make_with_ranges_at_constant_velocity(const config::TrackerConfig& config, std::size_t slots);
std::unique_ptr<Pasts> make_with_ranges_at_constant_acceleration(const config::TrackerConfig& config,
                                                                 std::size_t slots);

}  // namespace ttf::fusion::strategies::late
