// A fault that befalls single frames of one node.
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
  // Returns whether this fault befalls the signal, a frame of the node. Call it once per signal, when it leaves.
  bool befalls(const medium::Leaving& signal) {
    if (signal.sender != fault().node) return false;
    bool& befallen = befallen_[index_of(signal.channel)];
    befallen = signal.signal == bus::ports::Signal::kFrame && on(signal.channel) && active(signal.start) &&
               occasions_.chosen(plant().now(), signal.sender, [this](std::uint32_t index) { return draws(index); });
    return befallen;
  }
  // Returns whether the arriving signal is befallen. A guardian's coupler forwards a signal later than it left,
  // but before the node's next signal on that channel.
  bool befallen(const medium::Arriving& signal) const {
    return signal.sender == fault().node && !signal.emitted && signal.signal == bus::ports::Signal::kFrame &&
           befallen_[index_of(signal.channel)];
  }
  // The same for a marginal signal, which ends at the coupler: the coupler decodes it or not, for all receivers.
  bool befallen_as_sent(const medium::Arriving& signal) const { return !signal.regenerated && befallen(signal); }
  bool at_receiver(NodeId node) const {
    const auto& receivers = fault().receivers;
    return receivers.empty() || std::find(receivers.begin(), receivers.end(), node) != receivers.end();
  }
  // Returns draws about this frame; `part` stands for a channel and a receiver.
  RandomStream frame_draws(std::uint32_t part) const { return draws(occasions_.content() + kPartStride * part); }

 private:
  // Streams of parts are far apart: a run has fewer frames than this.
  static constexpr std::uint32_t kPartStride = 1U << 23;

  Occasions occasions_;
  std::array<bool, 2> befallen_{};  // by channel, for its last frame
};

}  // namespace ttf::sim::faults
