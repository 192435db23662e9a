// What befalls single frames of one node.
#pragma once

#include <algorithm>
#include <array>

#include "bus/wire/flexray_frame.h"
#include "sim/faults/active_fault.h"
#include "sim/faults/occasions.h"

namespace ttf::sim::faults {

class FrameFault : public ActiveFault {
 public:
  explicit FrameFault(const FaultSetting& setting)
      : ActiveFault(setting), occasions_(setting.fault.every, setting.fault.probability) {}

 protected:
  // Whether the signal is a frame of the node that this fault befalls. To be asked once per signal, when it leaves.
  bool befalls(const medium::Leaving& signal) {
    if (signal.sender != fault().node) return false;
    bool& befallen = befallen_[index_of(signal.channel)];
    befallen = signal.signal == bus::ports::Signal::kFrame && on(signal.channel) && active(signal.start) &&
               occasions_.chosen(plant().now(), signal.sender, [this](std::uint32_t index) { return draws(index); });
    return befallen;
  }
  // The same of what arrives of it. A guardian's coupler sends on what it has heard after a while, but before the node
  // sends anything else on that channel.
  bool befallen(const medium::Arriving& signal) const {
    return signal.sender == fault().node && !signal.emitted && signal.signal == bus::ports::Signal::kFrame &&
           befallen_[index_of(signal.channel)];
  }
  // And of what is marginal about it, which ends at the coupler: that makes it out one way or the other.
  bool befallen_as_sent(const medium::Arriving& signal) const { return !signal.regenerated && befallen(signal); }
  bool at_receiver(NodeId node) const {
    const auto& receivers = fault().receivers;
    return receivers.empty() || std::find(receivers.begin(), receivers.end(), node) != receivers.end();
  }
  // Draws about this frame; `part`: on a channel, at a receiver.
  RandomStream frame_draws(std::uint32_t part) const { return draws(occasions_.content() + kPartStride * part); }

 private:
  // Streams of parts are far apart: the frames of a run are fewer than this.
  static constexpr std::uint32_t kPartStride = 1U << 23;

  Occasions occasions_;
  std::array<bool, 2> befallen_{};  // by channel, its last frame
};

}  // namespace ttf::sim::faults
