// The way of a vehicle that commands drive: they come over the bus, while the drive goes on.
//
// An actuation is a demand on engine, brakes and steering from an instant on. It lies a dead time after the actuator's
// reading of the command. So in virtual time all actuations until an instant are known before any look at it; in real
// time one may become known late (insert()). The way is a pure function of them, in one process or in several, for any
// number of looks.
//
//   u   the newest command, within the actuator's limits; before the first one, no acceleration, and wheels as they are
//   a'  = (gain u - a) / lag            acceleration
//   d'  = (u_steering - d) / steering lag  angle of the front wheels, within the vehicle's rate
// Both are exact within a step of the vehicle's model (single_track.h), with their mean over the step. The vehicle does not
// drive backwards: braking ends in a standstill.
//
// When no actuation has come for the time `after`, or since the start for as long, the actuator holds the last one,
// lets it fade with the time constant `decay`, or brakes by `deceleration` with the wheels as they are. It does not ask
// for the reason: a list that got lost, came late or was refused, a dead controller, and an actuator without supply are
// all the same.
//
// States are kept on the world's grid of 10 ms. An instant between is a few steps of the model away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.h"
#include "sim/world/road/road.h"
#include "sim/world/vehicle/journey.h"

namespace ttf::sim::world::vehicle {

// From this instant on; the time is that of the world, which begins with the drive.
struct Actuation {
  TrueTime from{};
  double acceleration = 0.0;  // [m/s^2]
  double steering = 0.0;      // [rad]
};

enum class Inserted {
  kNew,
  kLate,     // new, but there was a look at its instant, or a later one, without it
  kKnown,    // one from that instant is there already
  kRefused,  // before the drive, or beyond the room
};

//   D1  after construction nothing allocates, as long as actuations come at most twice as often as readings (ActuatorConfig::between)
//   D2  a state at `t` is that of the actuations from instants up to `t`, however many looks there were before
//   D3  after insert() it is so for every later look: an actuation that became known late changes no earlier look
class Driven {
 public:
  // `config` has an actuator. `road` may be null where the vehicle does not start on a lane.
  Driven(const EgoConfig& config, const road::Road* road, Duration duration);

  // Adds an actuation. It is from an instant after the last one's, and after each look so far.
  void actuate(const Actuation& actuation);
  // Adds an actuation that became known in any order: early, late, or again. Its instant identifies it.
  Inserted insert(const Actuation& actuation);
  std::span<const Actuation> actuations() const { return actuations_; }  // in the order of their instants
  // Earlier states are those at the start; after the drive's end the motion goes on.
  RearAxleMotion at(TrueTime since_start);

 private:
  struct State {
    Motion motion;
    double pull = 0.0;          // [m/s^2]: the acceleration that engine and brakes give, even at a standstill
    std::size_t commands = 0;   // actuations that have begun
    std::int64_t at = 0;        // [ns]
    double acceleration = 0.0;  // during the last step
  };
  struct Demand {
    double acceleration = 0.0, steering = 0.0;
  };
  std::int64_t alone_from(const State& state) const;
  Demand demand(const State& state) const;
  std::int64_t next_change(const State& state, std::int64_t until) const;
  void step(State& state, std::int64_t ns) const;
  State advanced_to(State state, std::int64_t until) const;

  Parameters vehicle_;
  ActuatorConfig actuator_;
  std::vector<State> grid_;
  std::vector<Actuation> actuations_;
  std::size_t most_states_;
  std::int64_t looked_at_ = -1;  // [ns]: the latest look
};

}  // namespace ttf::sim::world::vehicle
