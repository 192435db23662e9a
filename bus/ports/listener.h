// A listener receives the lines of a live medium without being a node: for judging nodes that are not the
// program's own. A medium (live_medium.h) hands over nothing that is malformed; a listener does, as far as its
// identifier says whose frame it was to be.
//   L1  receive() never blocks, and nothing throws after construction
//   L2  the instants are those of LiveArrival::at
//   L3  on one line, what was sent first is received first
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/ports/can_port.h"
#include "bus/ports/live_medium.h"

namespace ttf::bus::ports {

struct ReceivedFrame {
  enum class Form : std::uint8_t {
    kFrame,      // a FlexRay frame in the medium's form: `bytes` of `slot`. Its frame CRC is not judged
    kFollowUp,   // `late` of the sync frame that came before: of `slot` in `cycle_counter`
    kCan,        // `can` on a private CAN
    kMalformed,  // not in the medium's form: `slot` on a channel, can.identifier on a private CAN
  };
  Form form = Form::kFrame;
  Line line = 0;
  MachineTime at{};
  int slot = 0;
  std::uint8_t cycle_counter = 0;
  Duration late{};
  std::span<const std::byte> bytes;  // valid until the next receive(), as the data of `can`
  CanFrame can;
};

// Identifiers by line; other frames are not received.
struct ReceivedIdentifiers {
  std::vector<int> slots;                       // on both channels
  std::vector<std::vector<std::uint32_t>> can;  // by Cluster::can_buses
};

class Listener {
 public:
  virtual ~Listener() = default;

  virtual std::optional<ReceivedFrame> receive() = 0;
  // Returns the number of frames that the listener had no room for.
  virtual std::uint64_t lost() const = 0;
  // Returns one sentence about a failed line; empty without a failure.
  virtual const std::string& failure() const = 0;
};

}  // namespace ttf::bus::ports
