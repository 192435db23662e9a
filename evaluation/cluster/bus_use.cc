#include "evaluation/cluster/bus_use.h"

#include <algorithm>

#include "bus/wire/can_timing.h"
#include "bus/wire/flexray_frame.h"

namespace ttf::evaluation::cluster {

// Counts a frame by its number of bits: its recorded times depend on an ordinary kernel.
void BusUse::on(const recording::records::SlotFrameSent& frame) {
  ++frames_sent_;
  const std::size_t least = bus::wire::kHeaderBytes + bus::wire::kTrailerBytes;
  if (frame.channel > 1 || frame.bytes.size() < least) return;
  channels_[frame.channel] +=
      bus::wire::frame_duration(cluster_.flexray, bus::wire::words_in_frame(frame.bytes.size()));
}

void BusUse::on(const recording::records::CanFrameSent& frame) {
  if (frame.bus >= cans_.size()) return;
  cans_[frame.bus] += bus::wire::can_frame_duration(cluster_.can_buses[frame.bus], frame.identifier, frame.data);
}

double BusUse::flexray_load(Duration elapsed) const {
  return std::max(channels_[0], channels_[1]).seconds() / elapsed.seconds();
}

std::vector<double> BusUse::can_load(Duration elapsed) const {
  std::vector<double> loads;
  for (const Duration busy : cans_) loads.push_back(busy.seconds() / elapsed.seconds());
  return loads;
}

}  // namespace ttf::evaluation::cluster
