// What separate processes of one node set say to each other in virtual time: whole messages, each from one node to all
// others. What is in a message is not this port's business (sim/processes/turn.h); who carries it is a leaf's
// (bus/dds/).
//
//   L1  every message of a member reaches every other member exactly once, unchanged
//   L2  messages of one member arrive in the order in which they were sent
//   L3  a member does not hear itself
//   L4  receive() sleeps until there is something; nothing spins
//   L5  who has been reported gone is heard no more, and all that it said before has been heard
#pragma once

#include <cstddef>
#include <span>

#include "core/ids.h"

namespace ttf::bus::ports {

class Exchange {
 public:
  // What receive() brings. Without bytes: the member is gone, for good.
  struct Heard {
    NodeId from{};
    bool gone = false;
    std::span<const std::byte> bytes;  // valid until the next call
  };

  virtual ~Exchange() = default;
  // Blocks only while others have no room. Throws std::runtime_error where the medium is lost.
  virtual void send(std::span<const std::byte> message) = 0;
  // The next message of anybody, or that somebody is gone. Throws std::runtime_error where the medium is lost.
  virtual Heard receive() = 0;
};

}  // namespace ttf::bus::ports
