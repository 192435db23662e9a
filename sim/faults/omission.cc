// A node's signals do not leave it, or other nodes' signals do not reach it: symbols as well as frames.
#include "sim/faults/families.h"
#include "sim/faults/occasions.h"

namespace ttf::sim::faults {
namespace {

using ttf::faults::FaultDirection;

class Omission final : public ActiveFault {
 public:
  explicit Omission(const FaultSetting& setting)
      : ActiveFault(setting), occasions_(setting.fault.every, setting.fault.probability) {}

  bool leaving(medium::Leaving& signal) override {
    if (fault().direction == FaultDirection::kReceive || signal.sender != fault().node ||
        !befalls(signal.channel, signal.start, signal.sender))
      return true;
    acted("a signal of {} on {} is not sent", name(signal.sender), letter(signal.channel));
    return false;
  }
  bool arriving(medium::Arriving& signal) override {
    if (fault().direction == FaultDirection::kSend || signal.receiver != fault().node ||
        !befalls(signal.channel, signal.start, signal.sender))
      return true;
    acted("{} does not receive a signal on {}", name(signal.receiver), letter(signal.channel));
    return false;
  }

 private:
  bool befalls(schedules::model::Channel channel, TrueTime start, NodeId sender) {
    return on(channel) && active(start) &&
           occasions_.chosen(plant().now(), sender, [this](std::uint32_t index) { return draws(index); });
  }

  Occasions occasions_;
};

}  // namespace

std::unique_ptr<ActiveFault> make_omission(const FaultSetting& setting) { return std::make_unique<Omission>(setting); }

}  // namespace ttf::sim::faults
