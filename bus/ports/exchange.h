// The exchange carries whole messages between the processes of one node set in virtual time, each from one
// node to all others. Their content is defined in sim/processes/turn.h; bus/dds/ carries them.
//
//   L1  every message of a member reaches every other member exactly once, unchanged
//   L2  messages of one member arrive in the order in which they were sent
//   L3  a member does not receive itself
//   L4  receive() sleeps until there is a message; it never spins
//   L5  all messages of a member are received before it is reported gone, and none afterwards
#pragma once

#include <cstddef>
#include <span>

#include "core/ids.h"

namespace ttf::bus::ports {

class Exchange {
 public:
  // One message of a member; without bytes: the member is gone for good.
  struct Received {
    NodeId from{};
    bool gone = false;
    std::span<const std::byte> bytes;  // valid until the next call
  };

  virtual ~Exchange() = default;
  // Sends a message to all others; blocks only while they have no room. Throws std::runtime_error if the
  // medium is lost.
  virtual void send(std::span<const std::byte> message) = 0;
  // Returns the next message, or that a member is gone. Throws std::runtime_error if the medium is lost.
  virtual Received receive() = 0;
};

}  // namespace ttf::bus::ports
