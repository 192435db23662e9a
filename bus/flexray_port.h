// The FlexRay port: what a controller and a medium owe each other. One small interface, many media (simulated, SocketCAN,
// DDS); all pass the laws below (tests/laws/).
//
// Instants are microticks of the node that states them. Converting them to true time or to a real clock is the business
// of whoever turns the crank.
//   L1  every transmission reaches every other controller on that channel exactly once, bytes unchanged
//   L2  a controller does not hear itself
//   L3  receptions reach one controller in the order of their end; ties: channel, then sender
//   L4  a frame is delivered at its end, never before it has left completely
//   L5  the medium keeps no reference to the bytes after transmit() returns
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.h"
#include "schedules/cluster.h"

namespace ttf::bus {

struct Transmission {
  schedules::Channel channel{};
  Microticks start{};                  // the action point: first bit of the frame's TSS leaves
  int slot = 0;
  std::span<const std::byte> bytes;    // header, payload, trailer
};

struct Reception {
  schedules::Channel channel{};
  Microticks start{};                  // when the first bit of the TSS arrived, receiver's clock
  Microticks end{};                    // when the last bit of the FES arrived, receiver's clock
  std::span<const std::byte> bytes;
};

class FlexRayPort {
 public:
  virtual ~FlexRayPort() = default;
  virtual void transmit(const Transmission& transmission) = 0;
};

}  // namespace ttf::bus
