// The CAN port sends a node's frames to a private CAN.
//   L1  every frame reaches every other controller on the bus exactly once, bytes unchanged
//   L2  a controller does not receive itself
//   L3  whenever the bus falls idle, the pending frame with the lowest identifier wins (ties: lower node)
//   L4  frames of one identifier from one node keep their order
//   L5  the medium keeps no reference to the data after send() returns
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ttf::bus::ports {

struct CanFrame {
  std::uint32_t identifier = 0;  // 11 bits
  bool flexible_data_rate = false;
  std::span<const std::byte> data;  // 0..8 bytes, or a CAN FD length up to 64
};

class CanPort {
 public:
  virtual ~CanPort() = default;
  virtual void send(const CanFrame& frame) = 0;
};

}  // namespace ttf::bus::ports
