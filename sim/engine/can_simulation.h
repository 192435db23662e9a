// The controllers of one private CAN without nodes' tasks, for thousands of runs of its faults. The user is the hosts:
// it queues their frames between two calls of run_until(). Single-threaded, and a pure function of its configuration.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/engine/plant.h"
#include "sim/medium/can_medium.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::engine {

// The controllers' reports to their hosts.
class CanHosts {
 public:
  virtual ~CanHosts() = default;
  // The frame's bytes are valid during the call only.
  virtual void received(NodeId receiver, const bus::ports::CanFrame& frame) = 0;
  virtual void sent(NodeId sender) = 0;  // a frame, without an error
};

class CanSimulation final : public Plant {
 public:
  // All nodes on this CAN begin with supply and idle. `sink` gets the medium's records, in true time.
  CanSimulation(const schedules::model::Cluster& cluster, std::size_t bus, CanHosts& hosts,
                recording::records::Sink& sink, std::uint64_t seed, std::uint32_t replication);

  medium::CanMedium& medium() { return medium_; }
  void set_disturbance(medium::Disturbance* disturbance);
  void send(NodeId sender, const bus::ports::CanFrame& frame) { medium_.send(sender, now_, frame); }
  // Handles everything up to `end`, which is not before now().
  void run_until(TrueTime end);

  // The plant: its nodes keep their supply, and have neither clocks nor FlexRay.
  TrueTime now() const override { return now_; }
  bool powered(NodeId node) const override { return medium_.has(node); }
  void power_off(NodeId node) override { medium_.power_off(node, now_); }
  void power_on(NodeId node, TrueTime at) override { medium_.power_on(node, at); }
  void change_drift(NodeId, std::int64_t) override {}
  void emit(const medium::Leaving& signal, std::optional<NodeId> source) override;
  medium::CanMedium* can(std::size_t bus) override { return bus == bus_ ? &medium_ : nullptr; }

 private:
  void happen(const medium::MediumEvent& event);

  std::size_t bus_;
  CanHosts& hosts_;
  medium::MediumQueue queue_;
  medium::FramePool pool_;
  medium::CanMedium medium_;
  medium::Disturbance* disturbance_ = nullptr;
  TrueTime now_{};
};

}  // namespace ttf::sim::engine
