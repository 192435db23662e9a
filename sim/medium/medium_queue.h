// What the media have pending in virtual time.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "sim/medium/event_queue.h"

namespace ttf::sim::medium {

// What is still to come on a medium: on FlexRay an arrival; on a private CAN an arbitration, the end of a frame for its
// sender and its arrival; and what reaches a host or device beside the buses: a trigger, a strobe, a recorded
// observation.
struct MediumEvent {
  enum class Kind : std::uint8_t {
    kFlexRayArrival,
    kCanArrival,
    kCanSent,
    kCanArbitration,
    kStrobe,
    kTrigger,
    kObservation
  };
  Kind kind{};
  std::uint8_t node = 0;  // receiver, or sender of what was sent; the bus for an arbitration
  std::uint8_t channel_or_bus = 0;
  std::uint8_t sensor = 0;
  std::uint8_t sender = 0;  // of a CAN frame
  bool flexible_data_rate = false;
  bool at_coupler = false;       // a FlexRay arrival not at a node but at the star coupler, from that node
  std::uint32_t identifier = 0;  // CAN identifier, or a measurement's sequence
  std::uint32_t frame = 0;       // in the pool; on FlexRay the medium's own number of the arrival
  TrueTime start{};              // of a CAN frame
};
using MediumQueue = EventQueue<MediumEvent>;

}  // namespace ttf::sim::medium
