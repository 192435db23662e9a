// Nodes that lose their supply, and clocks that change their rate.
#include <vector>

#include "sim/faults/families.h"

namespace ttf::sim::faults {
namespace {

// Takes the supply of some nodes at `from`, and gives it back at the fault's end.
class Supply final : public ActiveFault {
 public:
  Supply(const FaultSetting& setting, std::vector<NodeId> off)
      : ActiveFault(setting), off_(std::move(off)), next_(setting.from) {}

  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    const bool back = off_already_;
    for (const NodeId node : off_) {
      if (back)
        plant().power_on(node, now);
      else
        plant().power_off(node);
      acted("{} {}", name(node), back ? "has its supply back" : "loses its supply");
    }
    next_ = back || fault().duration == ttf::faults::Fault::kToTheEnd ? kNever<TrueTime> : until();
    off_already_ = true;
  }

 private:
  std::vector<NodeId> off_;
  TrueTime next_;
  bool off_already_ = false;
};

class Drift final : public ActiveFault {
 public:
  explicit Drift(const FaultSetting& setting) : ActiveFault(setting), next_(setting.from) {}

  TrueTime next() const override { return next_; }
  void act(TrueTime) override {
    plant().change_drift(fault().node, fault().drift_ppb);
    acted("{} drifts by {} ppm from now on", name(fault().node), static_cast<double>(fault().drift_ppb) / 1000.0);
    next_ = kNever<TrueTime>;
  }

 private:
  TrueTime next_;
};

}  // namespace

std::unique_ptr<ActiveFault> make_crash(const FaultSetting& setting) {
  return std::make_unique<Supply>(setting, std::vector{setting.fault.node});
}

std::unique_ptr<ActiveFault> make_lone_coldstart(const FaultSetting& setting) {
  std::vector<NodeId> off;
  for (std::size_t n = 0; n < setting.cluster.nodes.size(); ++n) {
    const auto& p = setting.cluster.nodes[n].flexray;
    if (n != index_of(setting.fault.node) && p && (p->pKeySlotUsedForStartup || setting.fault.all_others))
      off.push_back(static_cast<NodeId>(n));
  }
  return std::make_unique<Supply>(setting, std::move(off));
}

std::unique_ptr<ActiveFault> make_drift(const FaultSetting& setting) { return std::make_unique<Drift>(setting); }

}  // namespace ttf::sim::faults
