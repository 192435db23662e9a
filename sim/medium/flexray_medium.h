// The simulated FlexRay: two channels in virtual time, with the laws of bus/ports/flexray_port.h. It is a
// linear bus or a star (sim/medium/ways.h). A star without a coupler in its middle forwards everything, so it
// differs from a bus only by its delays. A signal reaches all nodes attached to the channel. Signals that
// overlap at a receiver arrive there as one undecodable signal.
//
// A bit-true medium carries frames as bytes: every frame is encoded and decoded, with its CRCs. A transparent
// medium carries the content of frames, and bytes only where a disturbance or a coupler may look at them.
// Receivers get the same from both.
//
// Flights carry signals from receiver to receiver. There are two kinds: the plain way (sim/medium/flights.h),
// and a fast way for a signal alone on its channel (sim/medium/clear_flights.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/medium/arrival.h"
#include "sim/medium/channel_log.h"
#include "sim/medium/clear_flights.h"
#include "sim/medium/coupler.h"
#include "sim/medium/disturbance.h"
#include "sim/medium/flights.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"
#include "sim/medium/ways.h"

namespace ttf::sim::medium {

class FlexRayMedium {
 public:
  // Room for signals on their way at once from the beginning, without those that have not reached a coupler yet. A
  // signal counts until it has ended at its last receiver; merged signals arrive with the one that ends last. A channel
  // has at most one signal of each sending node, the rest of one that broke off, and one emitted by each fault. The
  // frames that a fault delays come on top: one per slot in that time. If a fault plan makes more, there is more room.
  static constexpr std::size_t kFlights = 512;
  // The frames and queue events that it may need.
  static constexpr std::size_t kMostPending = kFlights + 64;
  // The room that a channel log needs.
  static constexpr std::size_t kMostLogged = kFlights + 128;

  FlexRayMedium(const schedules::model::Cluster& cluster, MediumQueue& queue, FramePool& pool);

  // Null: no disturbance.
  void set_disturbance(Disturbance* disturbance) { disturbance_ = disturbance; }
  void set_transparent(bool transparent) { transparent_ = transparent; }
  // Null: the fate of frames is not logged.
  void set_log(ChannelLog* log);
  // Sets the coupler in the middle of a star; null: the star forwards everything.
  void set_coupler(schedules::model::Channel channel, Coupler* coupler) { coupler_[index_of(channel)] = coupler; }
  // False: all signals go the plain way.
  void set_fast(bool fast) { fast_ = fast; }
  bool wants_bytes(NodeId sender, schedules::model::Channel channel) const {
    return log_ != nullptr || carries_bytes(sender, channel);
  }

  // Sends a node's signal. `start` and `end` are the true times of its first and last bit at the sender.
  void transmit(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // Sends one frame on both channels at once, without bytes; `transmission` says channel A.
  void transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // Emits a signal that no controller sends; it reaches all nodes on the channel at once. `source` is the
  // sender, if there is one.
  void emit(const Leaving& signal, std::optional<NodeId> source);
  // The node has lost its supply at `now`: its present signal ends there and becomes undecodable; a part merged
  // into another signal stays in it. Signals on their way to the node vanish.
  void power_off(NodeId node, TrueTime now);

  // Returns whether something is arriving at the node at `now`.
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;
  Duration delay(NodeId from, NodeId to) const { return ways_.delay(from, to); }
  // Returns the delay of a star's branch: from the node to the coupler, or back.
  Duration branch(NodeId node) const { return ways_.branch(node); }
  // Returns how long the nodes' signals have taken the channel so far.
  Duration busy(schedules::model::Channel channel) const { return busy_[index_of(channel)]; }

  // Returns the arrival of an event from the queue; nothing if the signal was merged into another, or arrives
  // at a coupler. The frame stays valid until release() is called with the same arrival.
  std::optional<Arrival> arrive(const MediumEvent& event, TrueTime now);
  // The same for a caller that follows a signal from receiver to receiver: returns its arrival, and whether it goes
  // on. Then next_arrival() turns the event into the next one and returns its place; that event is not in the queue.
  Stopover stop_over(const MediumEvent& event, TrueTime now);
  EventOrder next_arrival(MediumEvent& event) const;
  const bus::wire::DecodedFrame& frame(const Arrival& arrival) const { return pool_.decoded(arrival.frame); }
  void release(const Arrival& arrival) { medium::release(pool_, arrival); }

  // For a caller that follows a signal on both channels at once.
  ClearFlights& clear_flights() { return clear_flights_; }
  // For a caller that delivers a frame on both channels itself. Returns whether a frame sent now reaches all
  // other nodes on FlexRay as it leaves, while nothing else is sent or changed. The receivers and their delays
  // come from way_from(); delivered_on_both() reports the delivery to the medium.
  bool is_clear() const {
    return fast_ && ways_.same_on_both() && is_empty(schedules::model::Channel::kA) &&
           is_empty(schedules::model::Channel::kB) && transparent_ && is_undisturbed() && coupler_[0] == nullptr &&
           coupler_[1] == nullptr;
  }
  std::span<const Leg> way_from(NodeId sender) const { return ways_.from(sender)[0]; }
  void delivered_on_both(NodeId sender, TrueTime start, TrueTime end);

 private:
  // The start of a signal's ways to its receivers.
  struct Outset {
    const Ways* ways = nullptr;
    bool at_coupler = false;
    NodeId passed_over = kNoNode;  // on its way, but no receiver
  };
  // In a star: on its way to the coupler, where it has not begun yet.
  struct Approaching {
    Arrival arrival;
    FlightNumber number = 0;
    NodeId sender{};
    bool emitted = false;  // by a fault
  };
  struct Reached {
    Leg leg;
    Arrival arrival;
  };
  // A node's last signal, for the log.
  struct Spoken {
    TrueTime start{}, end{};
  };
  bool carries_bytes(NodeId sender, schedules::model::Channel channel) const {
    return !transparent_ || coupler_[index_of(channel)] != nullptr ||
           (disturbance_ != nullptr && disturbance_->touches(sender, channel));
  }
  bool is_empty(schedules::model::Channel channel) const {
    return !clear_flights_.any(channel) && !flights_.any(channel);
  }
  // Returns whether nothing looks at signals on their way: no disturbance, no log.
  bool is_undisturbed() const { return disturbance_ == nullptr && log_ == nullptr; }

  // `content` is that of a frame without bytes.
  void spread(const Leaving& signal, const Outset& outset, ChannelLog::Id logged,
              const bus::wire::DecodedFrame* content = nullptr);
  void pass_last_metres(const Leaving& signal, const Outset& outset, const Arrival& left);
  std::optional<Arrival> pass_last_metre(const Leaving& signal, const Outset& outset, const Leg& leg,
                                         const Arrival& left);
  bool is_as_it_left(const Arrival& left, int receivers) const;
  void to_coupler(const Leaving& signal, TrueTime now, ChannelLog::Id logged);
  void at_coupler(FlightNumber number);
  void break_off_to_coupler(NodeId sender, TrueTime now);
  void break_off(NodeId sender, schedules::model::Channel channel, TrueTime now);
  ChannelLog::Id witness(ChannelLog::Id logged, const Leaving& signal, const Arriving& last, bool arrives);
  // Returns whether the receiver sends at the same time; for the log.
  bool talks_over(const Arriving& last, schedules::model::Channel channel) const {
    const Spoken& own = spoken_[lane_of(last.receiver, channel)];
    return last.start < own.end && own.start < last.end;
  }
  void speaks(NodeId node, const Leaving& signal);
  static std::size_t lane_of(NodeId node, schedules::model::Channel channel) {
    return 2 * index_of(node) + index_of(channel);
  }

  const FlexRayWays ways_;
  MediumQueue& queue_;
  FramePool& pool_;
  Flights flights_;
  ClearFlights clear_flights_;
  std::vector<Reached> reached_;          // the receivers and the arrivals of the signal being spread
  std::array<Duration, 2> busy_{};        // by channel
  std::vector<TrueTime> sent_until_;      // by NodeId and channel
  std::vector<Spoken> spoken_;            // by NodeId and channel
  std::array<Coupler*, 2> coupler_{};     // by channel
  std::vector<Approaching> approaching_;  // on their way to a coupler
  Disturbance* disturbance_ = nullptr;
  ChannelLog* log_ = nullptr;
  bool transparent_ = false;
  bool fast_ = true;
};

// --- the work for every receiver

inline Stopover FlexRayMedium::stop_over(const MediumEvent& event, TrueTime now) {
  if (clear_flights_.is_one(event)) return clear_flights_.stop_over(event, now);
  if (!event.at_coupler) return flights_.stop_over(event, now);
  at_coupler(event.frame);
  return {};
}

inline EventOrder FlexRayMedium::next_arrival(MediumEvent& event) const {
  return clear_flights_.is_one(event) ? clear_flights_.next_arrival(event) : flights_.next_arrival(event);
}

}  // namespace ttf::sim::medium
