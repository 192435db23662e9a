// A simulated private CAN in virtual time: arbitration by identifier whenever the bus falls idle, durations with the
// exact stuff bits of the data.
//
// Other traffic (CanBus::other_load) is as bad as the checker takes it to be: the longest frames there are, at equal
// distances, so that they take that share, from a drawn instant on, each before all that the cluster sends. It is for
// no node, and no record tells of its frames; they count as time in which the bus is busy.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"

namespace ttf::sim::medium {

class CanMedium {
 public:
  // `sink` hears of each frame when it begins: what the wire carries, in true time. The rest its sender knows.
  // Seed and replication are of the instant at which other traffic begins.
  CanMedium(const schedules::model::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes,
            MediumQueue& queue, FramePool& pool, recording::records::Sink& sink, std::uint64_t seed,
            std::uint32_t replication);
  void send(NodeId sender, TrueTime now, const bus::ports::CanFrame& frame);
  // The node has lost its supply: what waits there is gone. A frame of its that is on the bus goes on to its end, and
  // it is for whoever takes arrivals from the queue to drop it.
  void power_off(NodeId node);
  // The bus is idle: the pending frame that wins is sent.
  void arbitrate(TrueTime now);
  // How long the bus has carried frames, the one on it included to its end; of other traffic what had begun when a
  // frame here was last queued or begun.
  Duration busy() const { return busy_; }

 private:
  struct Pending {
    NodeId sender{};
    std::uint64_t order = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::uint32_t frame = 0;
  };
  void report(const Pending& frame, TrueTime start, TrueTime end);
  void pass_others(TrueTime now);
  void arbitrate_at(TrueTime when);

  const schedules::model::Cluster& cluster_;
  std::size_t bus_;
  std::vector<NodeId> nodes_;
  MediumQueue& queue_;
  FramePool& pool_;
  recording::records::Sink& sink_;
  std::vector<Pending> pending_;
  std::uint64_t next_order_ = 0;
  TrueTime idle_from_{};
  Duration other_length_{}, other_period_{};  // of other traffic's frames; zero: there is none
  TrueTime next_other_{};                     // not on the bus yet
  bool arbitration_due_ = false;
  Duration busy_{};
};

}  // namespace ttf::sim::medium
