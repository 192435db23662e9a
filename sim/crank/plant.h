// What a fault may do to the machinery of a run, beside what it does to signals (sim/medium/disturbance.h). Every
// simulation is one.
//
// To be used from Disturbance::act() and while the simulation stands: never from within what a node does.
#pragma once

#include <cstdint>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::crank {

class Plant {
 public:
  virtual ~Plant() = default;
  virtual TrueTime now() const = 0;
  // Whether the node has its supply; who sleeps has it.
  virtual bool powered(NodeId node) const = 0;
  // The node loses its supply, at once. Nothing of it is left; what is on its way to it finds nobody; what it is
  // sending is cut off, and nobody can make out what has left of it. Without supply a node stays so.
  virtual void power_off(NodeId node) = 0;
  // A cold start of controller and host at `at`, not before now(); until then, and for a nanosecond at least, the node
  // is without supply.
  virtual void power_on(NodeId node, TrueTime at) = 0;
  // The node's oscillator deviates by this from now on; ticks already counted stay. With or without supply: a crystal
  // is what it is.
  virtual void change_drift(NodeId node, std::int64_t ppb) = 0;
  // What comes out of nothing and reaches everybody on the channel at once; `source` is the sender where there is one.
  // Its start is not before now().
  virtual void emit(const medium::Leaving& signal, std::optional<NodeId> source) = 0;
};

}  // namespace ttf::sim::crank
