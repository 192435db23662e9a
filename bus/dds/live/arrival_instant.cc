#include "bus/dds/live/arrival_instant.h"

#include <algorithm>

namespace ttf::bus::dds::live {

ports::MachineTime ArrivalInstant::of(NodeId sender, std::uint64_t host, std::int64_t sent,
                                      ports::MachineTime received) {
  Host& from = find(host);
  from.received = received;
  const Duration delay{received.ns - sent};
  const ports::MachineTime at = received - (delay - from.delay.least(received, delay));
  ports::MachineTime& last = last_[index_of(sender)];
  last = std::min(std::max(at, last), received);
  return last;
}

ArrivalInstant::Host& ArrivalInstant::find(std::uint64_t identity) {
  const auto found =
      std::find_if(hosts_.begin(), hosts_.end(), [identity](const Host& host) { return host.identity == identity; });
  if (found != hosts_.end()) return *found;
  if (hosts_.size() < most_hosts_) return hosts_.emplace_back(Host{identity, {}, {}});
  const auto silent = std::min_element(hosts_.begin(), hosts_.end(),
                                       [](const Host& a, const Host& b) { return a.received < b.received; });
  return *silent = Host{identity, {}, {}};
}

}  // namespace ttf::bus::dds::live
