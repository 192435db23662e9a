// The whole cluster in virtual time: one executive per node, the media between them, and true time, which only this
// room knows. Single-threaded; everything that happens is ordered by sim/event_queue.h, so a run is a pure function of
// its configuration.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "nodes/executive.h"
#include "recording/records/records.h"
#include "schedules/cluster.h"
#include "sim/can_medium.h"
#include "sim/flexray_medium.h"

namespace ttf::sim {

// The instant at which cycle 0 starts, give or take the nodes' initial phases.
inline constexpr TrueTime kFirstCycle{1'000'000};

struct SimulationConfig {
  const schedules::Cluster* cluster = nullptr;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  // The code of a node's tasks, in file order.
  std::function<std::vector<std::shared_ptr<nodes::Step>>(NodeId)> make_steps;
};

class ClusterSimulation final : private nodes::SensorLines {
 public:
  ClusterSimulation(const SimulationConfig& config, records::Sink& sink);
  ~ClusterSimulation() override;

  // Everything up to and including `end`.
  void run_until(TrueTime end);

  // The achieved precision so far: the largest difference between any two nodes' global times at one true instant. The
  // difference is piecewise linear with corners at the nodes' cycle starts and correction starts; it is taken there.
  Duration precision() const { return precision_; }
  const nodes::Executive& node(NodeId id) const { return *nodes_[index_of(id)]; }
  nodes::ExecutiveCounts counts() const;       // summed over the nodes
  Duration can_busy(std::size_t bus) const { return cans_[bus]->busy(); }
  std::uint64_t frames_sent() const { return frames_sent_; }   // on FlexRay, each channel's
  // How long the busier channel has been taken.
  Duration flexray_busy() const {
    return std::max(flexray_.busy(schedules::Channel::kA), flexray_.busy(schedules::Channel::kB));
  }

 private:
  struct FlexRayTap;
  struct CanTap;
  struct CanLog;

  void trigger(SensorId sensor) override;
  void strobe(SensorId sensor, std::uint32_t sequence) override;
  void deliver(const MediumEvent& event);
  void step_node(std::size_t node);
  void refresh(std::size_t node);
  void observe();
  void watch_cycle(std::size_t node);

  const schedules::Cluster& cluster_;
  records::Sink& sink_;
  MediumQueue queue_;
  FramePool pool_;
  FlexRayMedium flexray_;
  std::vector<std::unique_ptr<CanMedium>> cans_;
  std::vector<std::unique_ptr<FlexRayTap>> flexray_taps_;
  std::vector<std::unique_ptr<CanTap>> can_taps_;
  std::unique_ptr<CanLog> can_log_;
  std::vector<std::unique_ptr<nodes::Executive>> nodes_;
  std::vector<TrueTime> next_;                 // per node, its next own event
  std::vector<std::int64_t> watched_cycle_;    // per node, the cycle whose corners are being observed
  TrueTime now_{};
  Duration precision_{};
  Duration precision_of_pair_{};
  std::int64_t reported_pair_ = 0;
  std::uint64_t frames_sent_ = 0;
};

}  // namespace ttf::sim
