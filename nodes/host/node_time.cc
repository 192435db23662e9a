#include "nodes/host/node_time.h"

#include <algorithm>

namespace ttf::nodes::host {

recording::records::Stamp NodeTime::stamp(Microticks at) const {
  recording::records::Stamp stamp;
  stamp.true_time = oscillator_.time_of(at);
  if (true_clock_ != nullptr) stamp.true_time = std::max(stamp.true_time, true_clock_->now());
  stamp.local = oscillator_.local_time(at);
  // A node without global time has only its own.
  const timebase::CycleClock* const cluster = global();
  stamp.global = cluster != nullptr ? cluster->global_time(at) : GlobalTime{stamp.local.ns};
  stamp.node = node_;
  return stamp;
}

}  // namespace ttf::nodes::host
