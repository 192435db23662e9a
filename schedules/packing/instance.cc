#include "schedules/packing/instance.h"

#include <algorithm>
#include <iterator>

#include "core/check.h"

namespace ttf::schedules::packing {

Window window_of(Duration cycle, Duration release, Duration deadline, int repetition) {
  TTF_CHECK(cycle > Duration{} && release >= Duration{} && repetition >= 1, "cycle of {} ns, release at {} ns",
            cycle.ns, release.ns);
  const auto rounded_up = [&](Duration time) { return (time.ns + cycle.ns - 1) / cycle.ns; };
  const std::int64_t earliest = std::min<std::int64_t>(rounded_up(release), repetition);
  const std::int64_t latest = std::min<std::int64_t>(rounded_up(deadline) - 1, repetition - 1);
  return {static_cast<int>(earliest), static_cast<int>(latest)};
}

Order possible_signals(const Instance& instance) {
  Order order;
  for (std::size_t i = 0; i < instance.signals.size(); ++i)
    if (!instance.signals[i].window.empty() && instance.signals[i].bits <= instance.payload_bits) order.push_back(i);
  return order;
}

Order of_node(const Instance& instance, const Order& order, int node) {
  Order own;
  std::copy_if(order.begin(), order.end(), std::back_inserter(own),
               [&](std::size_t signal) { return instance.signals[signal].node == node; });
  return own;
}

}  // namespace ttf::schedules::packing
