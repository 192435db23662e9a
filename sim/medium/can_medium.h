// A simulated private CAN in virtual time: arbitration by identifier whenever the bus falls idle, durations
// with the exact stuff bits of the data.
//
// Other traffic (CanBus::other_load) is as bad as the checker assumes: the longest frames, at equal distances,
// which take that share of the bus. It begins at a drawn instant, and wins over all frames of the cluster. It
// has no receiver and no records here; it counts as busy time.
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
  // `sink` gets each frame at its begin, as the wire carries it, in true time; the sender knows the rest. Seed
  // and replication draw the instant at which other traffic begins.
  CanMedium(const schedules::model::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes,
            MediumQueue& queue, FramePool& pool, recording::records::Sink& sink, std::uint64_t seed,
            std::uint32_t replication);
  void send(NodeId sender, TrueTime now, const bus::ports::CanFrame& frame);
  // Drops the waiting frames of a node that has lost its supply. Its frame on the bus goes on to its end; the
  // reader of the queue drops that arrival.
  void power_off(NodeId node);
  // Decides the arbitration on an idle bus, and sends the winner.
  void arbitrate(TrueTime now);
  // Returns how long the bus has carried frames, with the present one counted to its end. Other traffic counts
  // up to the last instant at which a frame here was queued or begun.
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
  Duration other_length_{}, other_period_{};  // other traffic's frames; zero without them
  TrueTime next_other_{};                     // the next of them, not on the bus yet
  bool arbitration_due_ = false;
  Duration busy_{};
};

}  // namespace ttf::sim::medium
