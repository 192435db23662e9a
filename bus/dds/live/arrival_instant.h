// Estimates the arrival of a sample from another machine by this machine's clock. It is the departure by the
// sender's clock plus the least delay from that machine (bus/dds/live/least_delay.h). The receiving thread
// wakes up late, and that lateness says nothing about the sender's clock. Pure.
//
//   L1  never later than the sample was in hand
//   L2  for one sender never earlier than its previous sample: a falling minimum does not change the order
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bus/dds/live/least_delay.h"
#include "bus/ports/live_medium.h"
#include "core/ids.h"

namespace ttf::bus::dds::live {

class ArrivalInstant {
 public:
  // `most_hosts`: the number of senders; beyond it (after reboots) the machine silent for longest is forgotten.
  explicit ArrivalInstant(std::size_t most_hosts) { hosts_.reserve(most_hosts), most_hosts_ = most_hosts; }

  // Returns the arrival of a sample `sent` by the clock of `host` (host_identity(), not 0) and in hand at
  // `received`, which does not decrease.
  ports::MachineTime of(NodeId sender, std::uint64_t host, std::int64_t sent, ports::MachineTime received);

 private:
  struct Host {
    std::uint64_t identity = 0;
    ports::MachineTime received{};
    LeastDelay delay;
  };
  Host& find(std::uint64_t identity);

  std::size_t most_hosts_ = 0;
  std::vector<Host> hosts_;                     // those received so far
  std::array<ports::MachineTime, 256> last_{};  // by sender
};

}  // namespace ttf::bus::dds::live
