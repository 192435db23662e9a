// A car among the objects that a sensor sees.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "sim/world/world.h"

namespace ttf::sensors {

inline sim::world::ObjectState car_at(std::uint16_t id, double x, double y, double heading = 0.0) {
  sim::world::ObjectState state;
  state.id = ObjectId{id};
  state.x = x;
  state.y = y;
  state.heading = heading;
  state.length = 4.4;
  state.width = 1.8;
  return state;
}

}  // namespace ttf::sensors
