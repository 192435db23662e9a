// The truth: the port through which sensor emulators see the world at an instant. Only the sensors have this port.
#pragma once

#include <cstddef>
#include <vector>

#include "core/time.h"
#include "sim/world/ego.h"
#include "sim/world/road/road.h"
#include "sim/world/world.h"

namespace ttf::sensors {

using sim::world::EgoState;
using sim::world::ObjectState;

class Scene {
 public:
  virtual ~Scene() = default;
  // Writes the states of all objects at `at` into `out`, which keeps its capacity.
  virtual void states_at(TrueTime at, std::vector<ObjectState>& out) const = 0;
  // Returns the state of the sensors' vehicle; one that stands at the origin of the ground, unless the scene moves it.
  virtual EgoState ego_at(TrueTime) const { return {}; }
  // Returns the road, over ground; null where there is none.
  virtual const sim::world::road::Road* road() const { return nullptr; }
  // Returns the largest number of objects.
  virtual std::size_t objects() const = 0;
};

// The scenario's simulated world; drives begin at `start`.
class WorldScene final : public Scene {
 public:
  WorldScene(const sim::world::WorldConfig& config, std::uint64_t seed, std::uint32_t replication, TrueTime start)
      : world_(config, seed, replication), start_(start) {}
  void states_at(TrueTime at, std::vector<ObjectState>& out) const override {
    world_.states_at(TrueTime{} + (at - start_), out);
  }
  EgoState ego_at(TrueTime at) const override { return world_.ego_at(TrueTime{} + (at - start_)); }
  const sim::world::road::Road* road() const override { return world_.road(); }
  std::size_t objects() const override { return world_.size(); }
  const sim::world::World& world() const { return world_; }

 private:
  sim::world::World world_;
  TrueTime start_;
};

}  // namespace ttf::sensors
