// Faults that emit signals again and again: noise without a sender, a node that babbles, a coldstart node that
// never stops beginning.
#include <algorithm>
#include <array>

#include "bus/wire/flexray_frame.h"
#include "sim/faults/families.h"

namespace ttf::sim::faults {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

// Bursts of one kind, from the begin of the fault to its end, without overlap.
class Bursts : public ActiveFault {
 public:
  explicit Bursts(const FaultSetting& setting) : ActiveFault(setting), next_(setting.from) {}

  TrueTime next() const final { return next_; }
  void act(TrueTime now) final {
    TrueTime end = now;
    for (const Channel channel : kBothChannels)
      if (on(channel)) end = std::max(end, burst(now, channel));
    Duration pause = fault().interval;
    if (fault().jitter > Duration{}) pause += Duration{draws(count_).integer(0, fault().jitter.ns)};
    ++count_;
    // Time goes on, even after an empty burst.
    next_ = std::max({now + pause, end, now + Duration{1}});
    if (next_ >= until()) next_ = kNever<TrueTime>;
  }

 protected:
  // Sends a burst and returns its end.
  virtual TrueTime burst(TrueTime now, Channel channel) = 0;
  // Noise ends with the fault. A frame or a symbol is sent whole: it may end after the fault.
  TrueTime noise_until(TrueTime now) const { return std::min(now + fault().length, until()); }

 private:
  TrueTime next_;
  std::uint32_t count_ = 0;
};

class Noise final : public Bursts {
 public:
  using Bursts::Bursts;

 private:
  TrueTime burst(TrueTime now, Channel channel) override {
    const TrueTime end = noise_until(now);
    acted("noise on {} for {} ns", letter(channel), (end - now).ns);
    emit({kNoNode, channel, Signal::kUndecodable, now, end, {}}, std::nullopt);
    return end;
  }
};

class NodeBursts : public Bursts {
 public:
  using Bursts::Bursts;

 protected:
  const schedules::model::NodeParameters& parameters() const { return *cluster().node(fault().node).flexray; }
  // Takes its time even without a wire or a supply.
  TrueTime send(TrueTime now, Channel channel, Signal signal, TrueTime end, std::span<const std::byte> bytes) {
    if (!can_send(channel)) return end;
    acted("{} sends {} on {}, outside its schedule", name(fault().node), to_text(signal), letter(channel));
    emit({fault().node, channel, signal, now, end, bytes}, fault().node);
    return end;
  }
};

// Sends noise or the node's last frame; before its first frame, a null frame of its key slot.
class BabblingIdiot final : public NodeBursts {
 public:
  explicit BabblingIdiot(const FaultSetting& setting) : NodeBursts(setting) {
    bus::wire::FrameHeader header;
    header.null_frame = true;
    header.frame_id = static_cast<std::uint16_t>(parameters().pKeySlotId);
    const std::array<std::byte, bus::wire::kMaxPayloadBytes> nothing{};
    const auto payload =
        std::span<const std::byte>(nothing).first(2 * static_cast<std::size_t>(flexray().gPayloadLengthStatic));
    for (const Channel channel : kBothChannels) {
      Frame& frame = last_[index_of(channel)];
      frame.size = bus::wire::encode_frame(header, channel, payload, frame.bytes);
    }
  }

  // It repeats the node's last frame.
  bool touches(NodeId sender, Channel) const override { return sender == fault().node; }
  bool leaving(medium::Leaving& signal) override {
    if (signal.sender != fault().node || signal.signal != Signal::kFrame) return true;
    Frame& frame = last_[index_of(signal.channel)];
    std::copy(signal.bytes.begin(), signal.bytes.end(), frame.bytes.begin());
    frame.size = signal.bytes.size();
    return true;
  }

 private:
  struct Frame {
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    std::size_t size = 0;
  };
  TrueTime burst(TrueTime now, Channel channel) override {
    if (fault().signal == ttf::faults::FaultSignal::kNoise)
      return send(now, channel, Signal::kUndecodable, noise_until(now), {});
    const Frame& frame = last_[index_of(channel)];
    return send(now, channel, Signal::kFrame,
                now + bus::wire::frame_duration(flexray(), bus::wire::words_in_frame(frame.size)),
                std::span<const std::byte>(frame.bytes).first(frame.size));
  }

  std::array<Frame, 2> last_;  // by channel
};

class RepeatedCas final : public NodeBursts {
 public:
  using NodeBursts::NodeBursts;

 private:
  TrueTime burst(TrueTime now, Channel channel) override {
    const std::int64_t ps = (flexray().gdTSSTransmitter + schedules::model::kCasBits) * flexray().gdBit_ps;
    return send(now, channel, Signal::kCas, now + Duration{(ps + 999) / 1000}, {});
  }
};

// Sends startup frames once a nominal cycle, like a cluster that began with the fault; the cycle counter counts on.
class RogueStartup final : public ActiveFault {
 public:
  explicit RogueStartup(const FaultSetting& setting) : ActiveFault(setting), next_(setting.from) {}

  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    const schedules::model::NodeParameters& p = *cluster().node(fault().node).flexray;
    bus::wire::FrameHeader header;
    header.null_frame = header.sync = header.startup = true;
    header.frame_id = static_cast<std::uint16_t>(p.pKeySlotId);
    header.cycle = static_cast<std::uint8_t>(count_ % static_cast<std::uint32_t>(flexray().gCycleCountMax + 1));
    const std::array<std::byte, bus::wire::kMaxPayloadBytes> nothing{};
    const auto payload =
        std::span<const std::byte>(nothing).first(2 * static_cast<std::size_t>(flexray().gPayloadLengthStatic));
    const TrueTime end = now + bus::wire::frame_duration(flexray(), flexray().gPayloadLengthStatic);
    for (const Channel channel : kBothChannels) {
      if (!on(channel) || !can_send(channel)) continue;
      const std::size_t size = bus::wire::encode_frame(header, channel, payload, frame_);
      acted("{} sends a startup frame of cycle {} on {}, by a schedule of its own", name(fault().node), header.cycle,
            letter(channel));
      emit({fault().node, channel, Signal::kFrame, now, end, std::span<const std::byte>(frame_).first(size)},
           fault().node);
    }
    ++count_;
    next_ = from() + cluster().cycle() * count_;
    if (next_ >= until()) next_ = kNever<TrueTime>;
  }

 private:
  TrueTime next_;
  std::uint32_t count_ = 0;
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame_{};
};

}  // namespace

std::unique_ptr<ActiveFault> make_noise(const FaultSetting& setting) { return std::make_unique<Noise>(setting); }
std::unique_ptr<ActiveFault> make_babbling_idiot(const FaultSetting& setting) {
  return std::make_unique<BabblingIdiot>(setting);
}
std::unique_ptr<ActiveFault> make_duplicate_coldstart(const FaultSetting& setting) {
  if (setting.fault.duplicate == ttf::faults::DuplicateMode::kCas) return std::make_unique<RepeatedCas>(setting);
  return std::make_unique<RogueStartup>(setting);
}

}  // namespace ttf::sim::faults
