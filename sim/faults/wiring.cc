// Faults of the medium: a node's lines swapped, and all signals destroyed for a while.
#include "sim/faults/families.h"
#include "sim/faults/occasions.h"

namespace ttf::sim::faults {
namespace {

using schedules::model::Channel;

// A node's signals for A appear on B, and the other way round; their CRCs still say the right channel. The node
// receives in order. A node with one wire has nothing to swap.
class ChannelSwap final : public ActiveFault {
 public:
  explicit ChannelSwap(const FaultSetting& setting)
      : ActiveFault(setting), occasions_(setting.fault.every, setting.fault.probability) {}

  // It changes the channel.
  bool touches(NodeId sender, Channel) const override { return sender == fault().node; }
  bool leaving(medium::Leaving& signal) override {
    const Channel other = signal.channel == Channel::kA ? Channel::kB : Channel::kA;
    if (signal.sender != fault().node || !active(signal.start) || !can_send(other) ||
        !occasions_.chosen(plant().now(), signal.sender, [this](std::uint32_t index) { return draws(index); }))
      return true;
    acted("a signal of {} on {} appears on {}", name(signal.sender), letter(signal.channel), letter(other));
    signal.channel = other;
    return true;
  }

 private:
  Occasions occasions_;
};

// All signals on the channels in that time, in part or in whole, become undecodable. It adds no signal.
class Transient final : public ActiveFault {
 public:
  using ActiveFault::ActiveFault;

  bool arriving(medium::Arriving& signal) override {
    if (!on(signal.channel) || signal.start >= until() || signal.end <= from()) return true;
    signal.signal = bus::ports::Signal::kUndecodable;
    // Counted once for all receivers.
    if (plant().now() == last_ && signal.sender == last_sender_ && signal.channel == last_channel_) return true;
    last_ = plant().now();
    last_sender_ = signal.sender;
    last_channel_ = signal.channel;
    acted("a signal on {} is destroyed", letter(signal.channel));
    return true;
  }

 private:
  TrueTime last_{kNever<TrueTime>};
  NodeId last_sender_ = kNoNode;
  Channel last_channel_{};
};

}  // namespace

std::unique_ptr<ActiveFault> make_channel_swap(const FaultSetting& setting) {
  return std::make_unique<ChannelSwap>(setting);
}
std::unique_ptr<ActiveFault> make_transient(const FaultSetting& setting) {
  return std::make_unique<Transient>(setting);
}

}  // namespace ttf::sim::faults
