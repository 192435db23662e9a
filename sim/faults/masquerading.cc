// Frames that claim to be another node's, with a right CRC, and the frames of a node that believes in another schedule.
#include <array>

#include "bus/controller/slot_table.h"
#include "sim/faults/families.h"
#include "sim/faults/frame_fault.h"

namespace ttf::sim::faults {
namespace {

using schedules::model::Channel;
using schedules::model::FrameSlot;

// Changes the frame id of the node's own static frames to another node's.
class WrongFrameId final : public FrameFault {
 public:
  using FrameFault::FrameFault;

  bool touches(NodeId sender, Channel) const override { return sender == fault().node; }
  bool leaving(medium::Leaving& signal) override {
    if (!befalls(signal)) return true;
    const bus::wire::DecodedFrame decoded = bus::wire::decode_frame(signal.channel, signal.bytes);
    if (decoded.error != bus::wire::FrameError::kNone || decoded.header.frame_id > flexray().gNumberOfStaticSlots ||
        decoded.header.sync < decoded.header.startup)
      return true;
    bus::wire::FrameHeader header = decoded.header;
    header.frame_id = static_cast<std::uint16_t>(fault().slot);
    acted("a frame of {} on {} has frame id {} in slot {}", name(signal.sender), letter(signal.channel), fault().slot,
          decoded.header.frame_id);
    const std::size_t size = bus::wire::encode_frame(header, signal.channel, decoded.payload, frame_);
    signal.bytes = std::span<const std::byte>(frame_).first(size);
    return true;
  }

 private:
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame_{};
};

// Sends an additional frame in another node's slot. The node derives its instant from its own key slot and its cycles.
class InAnothersSlot final : public FrameFault {
 public:
  explicit InAnothersSlot(const FaultSetting& setting) : FrameFault(setting) {}

  TrueTime next() const override { return due_; }
  bool touches(NodeId sender, Channel) const override { return sender == fault().node; }

  bool leaving(medium::Leaving& signal) override {
    const schedules::model::NodeParameters& p = *cluster().node(fault().node).flexray;
    if (signal.sender != fault().node || signal.signal != bus::ports::Signal::kFrame || signal.start == key_slot_)
      return true;
    const bus::wire::DecodedFrame decoded = bus::wire::decode_frame(signal.channel, signal.bytes);
    if (decoded.error != bus::wire::FrameError::kNone || decoded.header.frame_id != p.pKeySlotId) return true;
    const int counters = flexray().gCycleCountMax + 1;
    const int cycles = (decoded.header.cycle - counter_ + counters) % counters;
    const bool paced = key_slot_ != kNever<TrueTime> && cycles > 0;
    const Duration cycle = paced ? Duration{(signal.start - key_slot_).ns / cycles} : cluster().cycle();
    key_slot_ = signal.start;
    counter_ = decoded.header.cycle;
    if (befalls_any_channel(signal)) plan(cycle, p.pKeySlotId);
    return true;
  }

  void act(TrueTime now) override {
    due_ = kNever<TrueTime>;
    const FrameSlot* owner = nullptr;
    for (const FrameSlot& slot : cluster().frames)
      if (slot.slot == fault().slot && schedules::model::in_cycle(slot, due_counter_)) owner = &slot;
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(fault().slot);
    header.cycle = static_cast<std::uint8_t>(due_counter_);
    if (owner != nullptr) {
      const auto& p = cluster().node(owner->sender).flexray;
      header.sync = p && p->pKeySlotUsedForSync && p->pKeySlotId == fault().slot;
      header.startup = header.sync && p->pKeySlotUsedForStartup;
    }
    const int words = flexray().gPayloadLengthStatic;
    const auto payload = std::span<std::byte>(payload_).first(2 * static_cast<std::size_t>(words));
    RandomStream stream = frame_draws(0);
    for (std::byte& byte : payload) byte = static_cast<std::byte>(stream.bits() & 0xffU);
    for (const Channel channel : kBothChannels) {
      if (!on(channel) || !can_send(channel)) continue;
      const std::size_t size = bus::wire::encode_frame(header, channel, payload, frame_);
      acted("{} sends a frame of slot {}, which another node owns, on {}", name(fault().node), fault().slot,
            letter(channel));
      emit({fault().node, channel, bus::ports::Signal::kFrame, now, now + bus::wire::frame_duration(flexray(), words),
            std::span<const std::byte>(frame_).first(size)},
           fault().node);
    }
  }

 private:
  // The key slot's frame stands for the cycle, even if it is on the other channel.
  bool befalls_any_channel(const medium::Leaving& signal) {
    medium::Leaving any = signal;
    any.channel = on(signal.channel) ? signal.channel : (on(Channel::kA) ? Channel::kA : Channel::kB);
    return befalls(any);
  }
  void plan(Duration cycle, int key_slot) {
    const int slots = fault().slot - key_slot;
    const std::int64_t macroticks = static_cast<std::int64_t>(slots) * flexray().gdStaticSlot;
    const Duration ahead{macroticks * cycle.ns / flexray().gMacroPerCycle};
    due_ = key_slot_ + (slots > 0 ? ahead : cycle + ahead);
    due_counter_ = (counter_ + (slots > 0 ? 0 : 1)) % (flexray().gCycleCountMax + 1);
    if (due_ >= until()) due_ = kNever<TrueTime>;
  }

  TrueTime key_slot_ = kNever<TrueTime>;  // start of its last frame there
  TrueTime due_ = kNever<TrueTime>;
  int counter_ = 0, due_counter_ = 0;
  std::array<std::byte, bus::wire::kMaxPayloadBytes> payload_{};
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame_{};
};

// The node's controller runs on the schedule that it believes in (faults/believed_schedule.h), and its frames follow.
class WrongBelief final : public ActiveFault {
 public:
  using ActiveFault::ActiveFault;

  bool leaving(medium::Leaving& signal) override {
    if (signal.sender == fault().node && signal.signal == bus::ports::Signal::kFrame)
      acted("{} sends a frame on {} by its wrong schedule", name(signal.sender), letter(signal.channel));
    return true;
  }
};

}  // namespace

std::unique_ptr<ActiveFault> make_masquerading(const FaultSetting& setting) {
  if (setting.fault.masquerade == ttf::faults::MasqueradeMode::kOwnSlot) return std::make_unique<WrongFrameId>(setting);
  return std::make_unique<InAnothersSlot>(setting);
}
std::unique_ptr<ActiveFault> make_wrong_schedule(const FaultSetting& setting) {
  return std::make_unique<WrongBelief>(setting);
}

}  // namespace ttf::sim::faults
