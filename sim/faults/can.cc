// Faults on a private CAN: at the node's host, in its controller, at its driver, and of the bits of its frames.
#include <algorithm>
#include <array>
#include <cstddef>

#include "sim/faults/families.h"

namespace ttf::sim::faults {
namespace {

using ttf::faults::FaultDirection;

class CanFault : public ActiveFault {
 public:
  using ActiveFault::ActiveFault;

  bool touches_can(std::size_t bus, TrueTime until) const override {
    return bus == fault().can && (from() < until) && (now() < this->until());
  }

 protected:
  bool is_at(std::size_t bus, NodeId node) const { return bus == fault().can && node == fault().node && active(now()); }
  // Null where the simulation has no CAN.
  medium::CanMedium* medium() { return fault().can == ttf::faults::Fault::kNoCan ? nullptr : plant().can(fault().can); }
  std::string_view can_name() const { return cluster().can_buses[fault().can].name; }
};

// A fault of single frames: every n-th, with a probability.
class CanFrameFault : public CanFault {
 public:
  using CanFault::CanFault;

 protected:
  bool chosen() {
    const std::uint32_t number = count_++;
    if (number % static_cast<std::uint32_t>(fault().every) != 0) return false;
    return fault().probability >= 1.0 || draws(2 * number).uniform() < fault().probability;
  }
  RandomStream frame_draws() const { return draws(2 * (count_ - 1) + 1); }

 private:
  std::uint32_t count_ = 0;
};

class CanOmission final : public CanFrameFault {
 public:
  using CanFrameFault::CanFrameFault;

  bool queues_on_can(std::size_t bus, NodeId sender) override {
    if (fault().direction == FaultDirection::kReceive || !is_at(bus, sender) || !chosen()) return true;
    acted("a frame of {} does not leave its host for {}", name(sender), can_name());
    return false;
  }
  bool arrives_from_can(std::size_t bus, NodeId receiver) override {
    if (fault().direction == FaultDirection::kSend || !is_at(bus, receiver) || !chosen()) return true;
    acted("the host of {} does not get a frame from {}", name(receiver), can_name());
    return false;
  }
};

class CanCorruption final : public CanFrameFault {
 public:
  using CanFrameFault::CanFrameFault;

  void begins_on_can(medium::CanBeginning& frame) override {
    if (!is_at(frame.bus, frame.sender) || !chosen()) return;
    const auto last = static_cast<std::int64_t>(frame.bits) - 1;
    const std::int64_t bit = fault().bit ? *fault().bit : frame_draws().integer(1, last);
    if (bit > last) return;  // the frame is shorter
    frame.inverted = static_cast<std::size_t>(bit);
    frame.seen_by = fault().receivers;
    acted("bit {} of a frame of {} on {} is inverted", bit, name(frame.sender), can_name());
  }
};

// It has one frame waiting behind the present one at most, so that the bus may be full of them.
class CanBabbling final : public CanFault {
 public:
  explicit CanBabbling(const FaultSetting& setting) : CanFault(setting), next_(setting.from) {}

  // Its frames are frames like others.
  bool touches_can(std::size_t, TrueTime) const override { return false; }
  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    medium::CanMedium* const can = medium();
    if (can != nullptr && can->has(fault().node) && can->waiting(fault().node, fault().identifier, now) < 2) {
      acted("{} sends a frame with identifier {} on {}, outside its schedule", name(fault().node), fault().identifier,
            can_name());
      static constexpr std::array<std::byte, 8> kNothing{};
      const bool flexible = cluster().can_buses[fault().can].flexible_data_rate;
      can->send(fault().node, now, {fault().identifier, flexible, kNothing}, true);
    }
    Duration pause = std::max(fault().interval, kShortest);
    if (fault().jitter > Duration{}) pause += Duration{draws(count_).integer(0, fault().jitter.ns)};
    ++count_;
    next_ = now + pause;
    if (next_ >= until()) next_ = kNever<TrueTime>;
  }

 private:
  static constexpr Duration kShortest = Duration::microseconds(10);  // no frame is as short

  TrueTime next_;
  std::uint32_t count_ = 0;
};

// Acts at its begin, and at its end.
class CanState : public CanFault {
 public:
  explicit CanState(const FaultSetting& setting) : CanFault(setting), next_(setting.from) {}

  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    medium::CanMedium* const can = medium();
    if (can != nullptr && can->has(fault().node)) {
      if (begun_)
        ends(*can, now);
      else
        begins(*can, now);
    }
    next_ = begun_ ? kNever<TrueTime> : until();
    begun_ = true;
  }

 protected:
  virtual void begins(medium::CanMedium& can, TrueTime now) = 0;
  virtual void ends(medium::CanMedium& can, TrueTime now) { (void)can, (void)now; }

 private:
  TrueTime next_;
  bool begun_ = false;
};

class CanBusOff final : public CanState {
 public:
  using CanState::CanState;

  // Its begin and its end come in the middle of a frame. Between them the medium needs no look at bits.
  bool touches_can(std::size_t bus, TrueTime until) const override { return bus == fault().can && next() < until; }

 private:
  void begins(medium::CanMedium& can, TrueTime now) override {
    acted("the controller of {} on {} goes bus off", name(fault().node), can_name());
    can.hold_off(fault().node, now);
  }
  void ends(medium::CanMedium& can, TrueTime now) override {
    acted("the controller of {} on {} may recover", name(fault().node), can_name());
    can.release(fault().node, now);
  }
};

class CanStuckDominant final : public CanState {
 public:
  using CanState::CanState;

  TrueTime holds_can(std::size_t bus) const override {
    return bus == fault().can && active(now()) && powered() ? until() : TrueTime{};
  }

 private:
  void begins(medium::CanMedium& can, TrueTime now) override {
    acted("{} holds {} dominant", name(fault().node), can_name());
    can.look(now);
  }
};

class CanNoAcknowledgement final : public CanState {
 public:
  using CanState::CanState;

  bool acknowledges_on_can(std::size_t bus, NodeId node) override { return !is_at(bus, node); }

 private:
  void begins(medium::CanMedium&, TrueTime) override {
    acted("{} does not acknowledge on {} any more", name(fault().node), can_name());
  }
};

}  // namespace

std::unique_ptr<ActiveFault> make_can_omission(const FaultSetting& setting) {
  return std::make_unique<CanOmission>(setting);
}
std::unique_ptr<ActiveFault> make_can_corruption(const FaultSetting& setting) {
  return std::make_unique<CanCorruption>(setting);
}
std::unique_ptr<ActiveFault> make_can_babbling(const FaultSetting& setting) {
  return std::make_unique<CanBabbling>(setting);
}
std::unique_ptr<ActiveFault> make_can_bus_off(const FaultSetting& setting) {
  return std::make_unique<CanBusOff>(setting);
}
std::unique_ptr<ActiveFault> make_can_stuck_dominant(const FaultSetting& setting) {
  return std::make_unique<CanStuckDominant>(setting);
}
std::unique_ptr<ActiveFault> make_can_no_acknowledgement(const FaultSetting& setting) {
  return std::make_unique<CanNoAcknowledgement>(setting);
}

}  // namespace ttf::sim::faults
