// The simulated FlexRay: two channels in virtual time, obeying the laws of bus/ports/flexray_port.h. It is a linear bus
// or a star (sim/medium/ways.h); without a coupler in its middle a star forwards everything, and is a bus but for the
// delays. What leaves reaches everybody who is attached to the channel; what overlaps at a receiver arrives there as
// one signal that nobody can make out.
//
// Bit-true, it carries frames as bytes, which every frame is encoded to and decoded from, CRCs and all. Transparent, it
// carries what they say, and bytes only where a disturbance or a coupler may look at them: all that anybody receives is
// the same.
//
// How signals go from receiver to receiver is the business of flights, of which there are two kinds: the plain way
// (sim/medium/flights.h), and a fast way for what has its channel to itself (sim/medium/clear_flights.h).
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
  // Signals on their way at once that there is room for from the beginning, beside those that have not reached a
  // coupler yet. A signal is one until it has ended at its last receiver, and no longer: what it is drawn into, or
  // what is drawn into it, arrives with the one of them that ends last. So there are, on either channel, at most one
  // that a node sends, what is left of one that broke off, one that each fault makes of nothing, and what a fault
  // makes late: a slot's frame for each slot in that time. Where a plan of faults makes more of it than this, there is
  // more room.
  static constexpr std::size_t kFlights = 512;
  // The frames and the events of the queue that it may need.
  static constexpr std::size_t kMostPending = kFlights + 64;
  // What a channel log has to have room for.
  static constexpr std::size_t kMostLogged = kFlights + 128;

  FlexRayMedium(const schedules::model::Cluster& cluster, MediumQueue& queue, FramePool& pool);

  // Null: nothing goes wrong.
  void set_disturbance(Disturbance* disturbance) { disturbance_ = disturbance; }
  void set_transparent(bool transparent) { transparent_ = transparent; }
  // Null: nobody is told what becomes of frames on their way.
  void set_log(ChannelLog* log);
  // In the middle of a star; null: it forwards everything.
  void set_coupler(schedules::model::Channel channel, Coupler* coupler) { coupler_[index_of(channel)] = coupler; }
  // False: all goes the plain way.
  void set_fast(bool fast) { fast_ = fast; }
  bool wants_bytes(NodeId sender, schedules::model::Channel channel) const {
    return log_ != nullptr || carries_bytes(sender, channel);
  }

  // What a node sends: `start`, `end`: true times of the first and last bit at the sender.
  void transmit(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // The same frame on both channels at once, without bytes; `transmission` says channel A.
  void transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // What comes out of nothing and reaches everybody on the channel at once; `source` is the sender where there is one.
  void emit(const Leaving& signal, std::optional<NodeId> source);
  // The node has lost its supply at `now`: what it is sending ends there and becomes undecodable (what was drawn into
  // another signal stays in it), and what is on its way to it vanishes.
  void power_off(NodeId node, TrueTime now);

  // Whether something is arriving at the node at `now`.
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;
  Duration delay(NodeId from, NodeId to) const { return ways_.delay(from, to); }
  // Of a star: from the node to the coupler, or back.
  Duration branch(NodeId node) const { return ways_.branch(node); }
  // How long the channel has been taken by what nodes sent so far.
  Duration busy(schedules::model::Channel channel) const { return busy_[index_of(channel)]; }

  // What an arrival of the queue brings: nothing where it was drawn into another signal, or where it is one at a
  // coupler. The frame stays valid until release() is called with the same arrival.
  std::optional<Arrival> arrive(const MediumEvent& event, TrueTime now);
  // The same for who goes along with a signal from receiver to receiver: what it brings where it is, and whether it
  // goes on from there. Then next_arrival() turns the event into its next one and says when that is; it is not in the
  // queue.
  Stopover stop_over(const MediumEvent& event, TrueTime now);
  EventOrder next_arrival(MediumEvent& event) const;
  const bus::wire::DecodedFrame& frame(const Arrival& arrival) const { return pool_.decoded(arrival.frame); }
  void release(const Arrival& arrival) { medium::release(pool_, arrival); }

  // For who goes along with a signal on both channels at once.
  ClearFlights& clear_flights() { return clear_flights_; }
  // Whether what a node sends on both channels at once now reaches everybody else on FlexRay as it leaves, as long as
  // nothing else is sent or changed until it is there; who they are and how far away; and that it was sent, when who
  // asks has told them.
  bool is_clear() const {
    return fast_ && ways_.same_on_both() && is_empty(schedules::model::Channel::kA) &&
           is_empty(schedules::model::Channel::kB) && transparent_ && is_undisturbed() && coupler_[0] == nullptr &&
           coupler_[1] == nullptr;
  }
  std::span<const Leg> way_from(NodeId sender) const { return ways_.from(sender)[0]; }
  void told_on_both(NodeId sender, TrueTime start, TrueTime end);

 private:
  // Where a signal sets out to its receivers.
  struct Outset {
    const Ways* ways = nullptr;
    bool at_coupler = false;
    NodeId passed_over = kNoNode;  // on its way, but no receiver
  };
  // Of a star: on its way to the coupler, where it has not begun yet.
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
  // When a node sent last, for the log.
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
  // Nobody looks at what is on its way.
  bool is_undisturbed() const { return disturbance_ == nullptr && log_ == nullptr; }

  // `content`: of a frame without bytes.
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
  // Whether the receiver sends at the same time; for the log.
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
  std::vector<Reached> reached_;          // whom, and how, the signal that is being spread
  std::array<Duration, 2> busy_{};        // by channel
  std::vector<TrueTime> sent_until_;      // by NodeId and channel
  std::vector<Spoken> spoken_;            // by NodeId and channel
  std::array<Coupler*, 2> coupler_{};     // by channel
  std::vector<Approaching> approaching_;  // a coupler
  Disturbance* disturbance_ = nullptr;
  ChannelLog* log_ = nullptr;
  bool transparent_ = false;
  bool fast_ = true;
};

// --- what is done for every receiver

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
