// The pending events of the media in virtual time.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "sim/medium/event_queue.h"

namespace ttf::sim::medium {

// A pending event of a medium. On FlexRay it is an arrival; on a private CAN an arbitration, a frame's acceptance for
// its sender, its arrival, or the end of bits. Beside the buses it is a trigger or a strobe, which reaches a device or host,
// or an observation of the nodes' clocks.
struct MediumEvent {
  enum class Kind : std::uint8_t {
    kFlexRayArrival,
    kCanArrival,
    kCanSent,
    kCanArbitration,
    kCanBits,
    kStrobe,
    kTrigger,
    kObservation
  };
  Kind kind{};
  std::uint8_t node = 0;  // receiver; sender of a sent frame
  std::uint8_t channel_or_bus = 0;
  std::uint8_t sensor = 0;
  std::uint8_t sender = 0;  // for a CAN frame
  bool flexible_data_rate = false;
  bool at_coupler = false;       // a FlexRay arrival at the star coupler, from that node
  std::uint32_t identifier = 0;  // CAN identifier, or a measurement's sequence
  std::uint32_t frame = 0;       // in the pool; on FlexRay the number of the flight
  TrueTime start{};              // for a CAN frame
};
using MediumQueue = EventQueue<MediumEvent>;

}  // namespace ttf::sim::medium
