// The simulated FlexRay: two channels in virtual time, obeying the laws of bus/flexray_port.h.
//
// A linear bus with the nodes equally spaced along it; the propagation delay between two nodes grows from
// gdMinPropagationDelay (neighbours at no distance) to gdMaxPropagationDelay (the two ends). What leaves reaches everybody who
// is attached to the channel; what overlaps at a receiver arrives there as one signal that nobody can make out.
//
// Or a star: every node on a branch of its own, each longer than the one before, the first of half gdMinPropagationDelay and the
// last two together of gdMaxPropagationDelay. Without a coupler in its middle a star forwards everything, and is a bus but
// for the delays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/cluster.h"
#include "sim/coupler.h"
#include "sim/disturbance.h"
#include "sim/frame_pool.h"
#include "sim/medium_queue.h"

namespace ttf::sim {

class FlexRayMedium {
 public:
  FlexRayMedium(const schedules::Cluster& cluster, MediumQueue& queue, FramePool& pool);

  // Null: nothing goes wrong.
  void set_disturbance(Disturbance* disturbance) { disturbance_ = disturbance; }
  // In the middle of a star; null: it forwards everything.
  void set_coupler(schedules::Channel channel, Coupler* coupler) { coupler_[index_of(channel)] = coupler; }

  // What a node sends: `start`, `end`: true times of the first and last bit at the sender.
  void transmit(NodeId sender, const bus::Transmission& transmission, TrueTime start, TrueTime end);
  // What comes out of nothing and reaches everybody on the channel at once; `source` is the sender where there is one.
  void emit(const Leaving& signal, std::optional<NodeId> source);
  // The node has lost its supply at `now`: what it is sending ends there and becomes undecodable (what was drawn into
  // another signal stays in it), and what is on its way to it vanishes.
  void power_off(NodeId node, TrueTime now);
  // Whether something is arriving at the node at `now`.
  bool carrier(NodeId node, schedules::Channel channel, TrueTime now) const;
  Duration delay(NodeId from, NodeId to) const;
  // Of a star: from the node to the coupler, or back.
  Duration branch(NodeId node) const;
  // How long the channel has been taken by what nodes sent so far.
  Duration busy(schedules::Channel channel) const { return busy_[index_of(channel)]; }

  // What an arrival of the queue brings: nothing where it was drawn into another signal, or where it is one at a coupler. The frame stays valid until
  // release() is called with the same arrival.
  struct Arrival {
    schedules::Channel channel{};
    bus::Signal signal{};
    TrueTime start{}, end{};
    std::uint32_t frame = 0;          // in the pool, of a frame
  };
  std::optional<Arrival> arrive(const MediumEvent& event, TrueTime now);
  const wire::DecodedFrame& frame(const Arrival& arrival) const { return pool_.decoded(arrival.frame); }
  void release(const Arrival& arrival);

 private:
  // What is on its way to one node on one channel.
  struct Pending {
    std::uint32_t id = 0;             // the queue's event carries it
    Arrival arrival;
    NodeId sender{};
    bool merged = false;              // of several signals
  };
  using Lane = std::vector<Pending>;
  std::int64_t branch_ps(NodeId node) const;
  void spread(const Leaving& signal, std::optional<NodeId> sender, bool regenerated);
  void to_coupler(const Leaving& signal, NodeId sender, TrueTime now);
  void at_coupler(const MediumEvent& event);
  void put(NodeId receiver, NodeId sender, const Arrival& arrival);
  void take_out(Lane& pending, std::size_t index);
  static std::size_t lane_of(NodeId node, schedules::Channel channel) { return 2 * index_of(node) + index_of(channel); }
  Lane& lane(NodeId node, schedules::Channel channel) { return lanes_[lane_of(node, channel)]; }

  MediumQueue& queue_;
  FramePool& pool_;
  std::array<std::vector<NodeId>, 2> attached_;   // by channel, in bus order
  std::vector<int> position_;                     // by NodeId, -1 off the bus
  std::vector<Lane> lanes_;                       // by NodeId and channel
  std::array<Duration, 2> busy_{};                // by channel
  std::vector<TrueTime> sent_until_;              // by NodeId and channel
  int ends_ = 0;                                  // hops between the two ends of the line
  std::int64_t min_delay_ps_, max_delay_ps_;
  std::uint32_t next_id_ = 0;
  bool star_;
  std::array<Coupler*, 2> coupler_{};             // by channel
  std::vector<Pending> to_coupler_;               // signals that have not begun there yet
  Disturbance* disturbance_ = nullptr;
};

}  // namespace ttf::sim
