// When what comes on a line from other hosts has arrived by this host's clock: when it left by its sender's, and the
// least delay from that host (bus/dds/live/least_delay.h), as the thread that receives it wakes up late, and by how
// much says nothing about the sender's clock. Pure.
//
//   L1  never later than it was in hand
//   L2  of one sender never earlier than what came from it before: a minimum that falls does not change the order
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
  // `most_hosts`: as many as there are senders; of more (after reboots) who has been silent for longest is forgotten.
  explicit ArrivalInstant(std::size_t most_hosts) { hosts_.reserve(most_hosts), most_hosts_ = most_hosts; }

  // Of what was `sent` by the clock of `host` (host_identity(), not 0) and in hand at `received`, which does not
  // decrease.
  ports::HostTime of(NodeId sender, std::uint64_t host, std::int64_t sent, ports::HostTime received);

 private:
  struct Host {
    std::uint64_t identity = 0;
    ports::HostTime heard{};
    LeastDelay delay;
  };
  Host& find(std::uint64_t identity);

  std::size_t most_hosts_ = 0;
  std::vector<Host> hosts_;                  // those heard so far
  std::array<ports::HostTime, 256> last_{};  // by sender
};

}  // namespace ttf::bus::dds::live
