// The simulated FlexRay: two channels in virtual time, obeying the laws of bus/ports/flexray_port.h.
//
// A linear bus with the nodes equally spaced along it; the propagation delay between two nodes grows from
// gdMinPropagationDelay (neighbours at no distance) to gdMaxPropagationDelay (the two ends). What leaves reaches
// everybody who is attached to the channel; what overlaps at a receiver arrives there as one signal that nobody can
// make out.
//
// Bit-true, it carries frames as bytes, which every frame is encoded to and decoded from, CRCs and all. Transparent, it
// carries what they say, and bytes only where a disturbance or a coupler may look at them: all that anybody receives is
// the same.
//
// Or a star: every node on a branch of its own, from half gdMinPropagationDelay for the first to half
// gdMaxPropagationDelay for the last two. Without a coupler in its middle a star forwards everything, and is a bus but
// for the delays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/ports/flexray_port.h"
#include "core/check.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/medium/channel_log.h"
#include "sim/medium/coupler.h"
#include "sim/medium/disturbance.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"

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
  void set_log(ChannelLog* log) { log_ = log; }
  bool wants_bytes(NodeId sender, schedules::model::Channel channel) const {
    return log_ != nullptr || carries_bytes(sender, channel);
  }
  // In the middle of a star; null: it forwards everything.
  void set_coupler(schedules::model::Channel channel, Coupler* coupler) { coupler_[index_of(channel)] = coupler; }

  // What a node sends: `start`, `end`: true times of the first and last bit at the sender.
  void transmit(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // The same frame on both channels at once, without bytes; `transmission` says channel A.
  void transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // Whether what a node sends on both channels at once now reaches everybody else on FlexRay as it leaves, as long as
  // nothing else is sent or changed until it is there; who they are and how far away; and that it was sent, when who
  // asks has told them.
  bool is_clear() const {
    return same_receivers_ && aloft_[0] == 0 && aloft_[1] == 0 && transparent_ && disturbance_ == nullptr &&
           log_ == nullptr && coupler_[0] == nullptr && coupler_[1] == nullptr;
  }
  struct Leg {
    NodeId receiver{};
    Duration delay{};
  };
  std::span<const Leg> way_from(NodeId sender) const { return ways_[index_of(sender)][0]; }
  void told_on_both(NodeId sender, TrueTime start, TrueTime end);
  // What comes out of nothing and reaches everybody on the channel at once; `source` is the sender where there is one.
  void emit(const Leaving& signal, std::optional<NodeId> source);
  // The node has lost its supply at `now`: what it is sending ends there and becomes undecodable (what was drawn into
  // another signal stays in it), and what is on its way to it vanishes.
  void power_off(NodeId node, TrueTime now);
  // Whether something is arriving at the node at `now`.
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;
  Duration delay(NodeId from, NodeId to) const;
  // Of a star: from the node to the coupler, or back.
  Duration branch(NodeId node) const;
  // How long the channel has been taken by what nodes sent so far.
  Duration busy(schedules::model::Channel channel) const { return busy_[index_of(channel)]; }

  // What an arrival of the queue brings: nothing where it was drawn into another signal, or where it is one at a
  // coupler. The frame stays valid until release() is called with the same arrival.
  struct Arrival {
    TrueTime start{}, end{};
    std::uint32_t frame = 0;  // in the pool, of a frame
    schedules::model::Channel channel{};
    bus::ports::Signal signal{};
    ChannelLog::Id logged = ChannelLog::kNone;  // while its receiver may still make it out
  };
  std::optional<Arrival> arrive(const MediumEvent& event, TrueTime now);
  // The same for who goes along with a signal from receiver to receiver: what it brings where it is, and whether it
  // goes on from there. Then next_arrival() turns the event into its next one and says when that is; it is not in the
  // queue.
  struct Stopover {
    std::optional<Arrival> arrival;
    bool goes_on = false;
  };
  Stopover stop_over(const MediumEvent& event, TrueTime now) {
    const bool clear = !event.at_coupler && flights_[event.frame].ways != nullptr;
    return clear ? stop_over_clear(flights_[event.frame], now) : stop_over_noted(event, now);
  }
  EventOrder next_arrival(MediumEvent& event) const;
  // Whether it is one frame that stops on A and on B at once wherever it still goes; and when it will have done so.
  // Then pass_on_both() is both stops at the receiver that is next; the frame stays valid until it is released on both.
  bool passes_on_both(const MediumEvent& event) const {
    const Flight& flight = flights_[event.frame];
    return !event.at_coupler && flight.ways != nullptr && flight.both_channels &&
           flight.channel == schedules::model::Channel::kA && flight.left[0].signal == bus::ports::Signal::kFrame &&
           flight.left[0].frame == flight.left[1].frame;
  }
  EventOrder last_arrival(const MediumEvent& event) const;
  struct Passage {
    NodeId receiver{};
    Arrival on_a;
    bool goes_on = false;
  };
  Passage pass_on_both(const MediumEvent& event);
  void release_on_both(const Arrival& arrival) { pool_.release(arrival.frame, 2); }
  const bus::wire::DecodedFrame& frame(const Arrival& arrival) const { return pool_.decoded(arrival.frame); }
  void release(const Arrival& arrival) {
    if (arrival.signal == bus::ports::Signal::kFrame) pool_.release(arrival.frame);
  }

 private:
  // What is on its way to one node on one channel.
  struct Pending {
    Arrival arrival;
    std::uint32_t id = 0;  // a stop of a flight has it
    NodeId sender{};
    bool merged = false;   // of several signals
    bool emitted = false;  // on its way to a coupler: by a fault
  };
  // Those on their way to one node on one channel, in no order, no two of them at once: hardly ever more than one, but
  // for what a fault makes late.
  static constexpr std::size_t kLaneRoom = 64;
  class Lane {
   public:
    Lane() { room_.reserve(kLaneRoom); }
    std::size_t size() const { return room_.size(); }
    auto begin() { return room_.begin(); }
    auto end() { return room_.end(); }
    auto begin() const { return room_.begin(); }
    auto end() const { return room_.end(); }
    Pending& operator[](std::size_t index) { return room_[index]; }
    void add(const Pending& pending) { room_.push_back(pending); }
    void take_out(std::size_t index) {
      room_[index] = room_.back();
      room_.pop_back();
    }
    void clear() { room_.clear(); }

   private:
    std::vector<Pending> room_;
  };
  using Way = std::vector<Leg>;     // from a sender, or from the coupler of a star, to all; by (delay, receiver)
  using Ways = std::array<Way, 2>;  // by channel
  // One signal on its way to all its receivers: a single event of the queue, which goes on from one stop to the next.
  struct Stop {
    TrueTime end{};
    NodeId receiver{};
    std::uint32_t id = 0;
  };
  // A flight is clear while its signal is as it left and has its channel to itself: then it stops wherever its way
  // leads, and no lane knows of it. What leaves on both channels at once and is clear on both, for the same receivers,
  // is one flight, which stops on A and then on B.
  struct Flight {
    std::size_t size = 0, next = 0;  // stops, by (end, receiver) once it has departed; none of a clear flight
    Stop last_heard;                 // the end of what it brings, wherever that is drawn into
    std::uint64_t sequence = 0;      // in the queue
    ChannelLog::Id logged = ChannelLog::kNone;
    NodeId sender{};
    schedules::model::Channel channel{};  // of the next stop
    // Of a clear flight:
    const Ways* ways = nullptr;    // null: it is none
    const Leg* leg = nullptr;      // to the next stop; on both channels the legs are the same
    const Leg* last = nullptr;     // behind the last one
    NodeId passed_over = kNoNode;  // on its way, but no receiver
    bool both_channels = false;
    std::array<Arrival, 2> left{};  // as it left, by channel
  };
  // When a node sent last, for the log.
  struct Spoken {
    TrueTime start{}, end{};
  };
  bool carries_bytes(NodeId sender, schedules::model::Channel channel) const {
    return !transparent_ || coupler_[index_of(channel)] != nullptr ||
           (disturbance_ != nullptr && disturbance_->touches(sender, channel));
  }
  Way make_way(schedules::model::Channel channel, std::optional<NodeId> sender, bool from_coupler) const;
  std::int64_t branch_ps(NodeId node) const;
  // `content`: of a frame without bytes.
  void spread(const Leaving& signal, std::optional<NodeId> sender, bool regenerated, ChannelLog::Id logged,
              const bus::wire::DecodedFrame* content = nullptr);
  void to_coupler(const Leaving& signal, NodeId sender, TrueTime now, ChannelLog::Id logged);
  void at_coupler(const MediumEvent& event);
  std::span<Stop> stops_of(const Flight& flight) {
    return std::span(stops_).subspan(static_cast<std::size_t>(&flight - flights_.data()) * most_stops_, most_stops_);
  }
  void add_flights(std::size_t count);
  Flight& take_off(NodeId sender, schedules::model::Channel channel, ChannelLog::Id logged);
  void land(Flight& flight);
  ChannelLog::Id witness(ChannelLog::Id logged, const Leaving& signal, const Arriving& last, bool arrives);
  // Whether the receiver sends at the same time; for the log.
  bool talks_over(const Arriving& last, schedules::model::Channel channel) const {
    const Spoken& own = spoken_[lane_of(last.receiver, channel)];
    return last.start < own.end && own.start < last.end;
  }
  void speaks(NodeId node, const Leaving& signal);
  void put(Flight& flight, NodeId receiver, const Arrival& arrival);
  void depart(Flight& flight);
  Stopover stop_over_noted(const MediumEvent& event, TrueTime now);
  MediumEvent event_of(const Flight& flight) const;
  void schedule(Flight& flight);
  // --- clear flights (flexray_clear_flights.cc)
  void depart_clear(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over);
  Flight& take_off_clear(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over);
  void join(Flight& on_a, const Arrival& left);
  static const Leg* first_leg(const Flight& flight);
  static EventOrder order_of(const Flight& flight, schedules::model::Channel channel, const Leg& leg) {
    const auto rank = static_cast<std::uint16_t>((index_of(channel) << 8) | index_of(flight.sender));
    return {flight.left[index_of(channel)].end + leg.delay, Phase::kArrival, static_cast<std::uint8_t>(leg.receiver),
            rank, flight.sequence};
  }
  static Arrival after(const Arrival& left, Duration delay) {
    return {left.start + delay, left.end + delay, left.frame, left.channel, left.signal, left.logged};
  }
  Stopover stop_over_clear(Flight& flight, TrueTime now);
  void stopped_on_a(Flight& flight);
  void land_clear(Flight& flight);
  bool carrier_of_clear(const Flight& flight, NodeId node, schedules::model::Channel channel, TrueTime now) const;
  // Something else comes onto the channel: what is clear there is so no longer.
  void crowd(schedules::model::Channel channel);
  void lay_out(Flight& flight, std::span<const Leg> way, NodeId passed_over, const Arrival& left);
  static std::size_t lane_of(NodeId node, schedules::model::Channel channel) {
    return 2 * index_of(node) + index_of(channel);
  }
  Lane& lane(NodeId node, schedules::model::Channel channel) { return lanes_[lane_of(node, channel)]; }

  MediumQueue& queue_;
  FramePool& pool_;
  std::array<std::vector<NodeId>, 2> attached_;  // by channel
  std::vector<int> position_;                    // by NodeId, -1 off the bus
  std::vector<Lane> lanes_;                      // by NodeId and channel
  bool same_receivers_;                          // whoever is attached is so to both channels
  std::vector<Ways> ways_;                       // by sender
  Ways from_nowhere_, from_coupler_;
  std::vector<Stop> stops_;     // most_stops_ for each flight
  std::size_t most_stops_ = 0;  // a node each
  std::vector<Flight> flights_;
  std::vector<std::uint32_t> free_flights_;
  std::array<Flight*, 2> clear_{};    // by channel; null where there is none
  std::array<int, 2> aloft_{};        // flights, by channel; none beside a clear one
  std::array<Duration, 2> busy_{};    // by channel
  std::vector<TrueTime> sent_until_;  // by NodeId and channel
  std::vector<Spoken> spoken_;        // by NodeId and channel
  int ends_ = 0;                      // hops between the two ends of the line
  std::int64_t min_delay_ps_, max_delay_ps_;
  std::uint32_t next_id_ = 0;
  bool star_;
  std::array<Coupler*, 2> coupler_{};  // by channel
  std::vector<Pending> to_coupler_;    // signals that have not begun there yet
  Disturbance* disturbance_ = nullptr;
  ChannelLog* log_ = nullptr;
  bool transparent_ = false;
};

// --- what is done for every receiver

inline FlexRayMedium::Stopover FlexRayMedium::stop_over_clear(Flight& flight, TrueTime now) {
  using schedules::model::Channel;
  const Stopover here{after(flight.left[index_of(flight.channel)], flight.leg->delay), true};
  TTF_CHECK(here.arrival->end == now, "an arrival of {} ns at {} ns", here.arrival->end.ns, now.ns);
  if (flight.both_channels) {
    flight.channel = flight.channel == Channel::kA ? Channel::kB : Channel::kA;
    if (flight.channel == Channel::kB) {
      if (log_ != nullptr) stopped_on_a(flight);
      return here;
    }
  }
  do ++flight.leg;
  while (flight.leg != flight.last && flight.leg->receiver == flight.passed_over);
  if (flight.leg != flight.last) return here;
  land_clear(flight);
  return {here.arrival, false};
}

inline EventOrder FlexRayMedium::next_arrival(MediumEvent& event) const {
  const Flight& flight = flights_[event.frame];
  const bool clear = flight.ways != nullptr;
  const Stop* const stop = clear ? nullptr : &stops_[event.frame * most_stops_ + flight.next];
  const NodeId receiver = clear ? flight.leg->receiver : stop->receiver;
  const TrueTime end = clear ? flight.left[index_of(flight.channel)].end + flight.leg->delay : stop->end;
  event.node = static_cast<std::uint8_t>(receiver);
  event.channel_or_bus = static_cast<std::uint8_t>(flight.channel);
  const auto rank = static_cast<std::uint16_t>((index_of(flight.channel) << 8) | index_of(flight.sender));
  return {end, Phase::kArrival, event.node, rank, flight.sequence};
}

}  // namespace ttf::sim::medium
