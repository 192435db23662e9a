// A fault's access to the machinery of a run, beside its access to signals (sim/medium/disturbance.h). Every
// simulation is a plant.
//
// Use it from Disturbance::act() and while the simulation stands, never from within a node's work.
#pragma once

#include <cstdint>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "sim/medium/can_medium.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::engine {

class Plant {
 public:
  virtual ~Plant() = default;
  virtual TrueTime now() const = 0;
  // Returns whether the node has its supply; a sleeping node has it.
  virtual bool powered(NodeId node) const = 0;
  // Takes the node's supply away at once, with all its state. Signals on their way to it are lost; its own are
  // cut off, and become undecodable. A node without supply stays so.
  virtual void power_off(NodeId node) = 0;
  // Starts controller and host cold at `at`, not before now(). Until then, and for a nanosecond at least, the
  // node is without supply.
  virtual void power_on(NodeId node, TrueTime at) = 0;
  // Sets the deviation of the node's oscillator from now on; ticks already counted stay. It works with or
  // without supply.
  virtual void change_drift(NodeId node, std::int64_t ppb) = 0;
  // Emits a signal that no controller transmits; it reaches all nodes on the channel at once. `source` is the
  // sender, if there is one. The signal's start is not before now().
  virtual void emit(const medium::Leaving& signal, std::optional<NodeId> source) = 0;
  // Returns a private CAN; null if the simulation has none.
  virtual medium::CanMedium* can(std::size_t bus) { return (void)bus, nullptr; }
};

}  // namespace ttf::sim::engine
