// Flights: each is one signal on its way to all its receivers, from its departure to its last stop. A flight is
// a single event of the queue, which goes on from one stop to the next.
//
// This is the plain way: a signal on its way is noted at each of its receivers, and signals that overlap there
// become one. The fast way, for a signal alone on its channel (sim/medium/clear_flights.h), obeys the same laws:
//   L1  stop_over() of a flight's event, at its instant, returns the arrival there; then next_arrival() is its next
//       stop, as long as it goes on
//   L2  stops come in the order of (end, receiver)
//   L3  carrier() is true from the start of an arrival until stop_over() takes it
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/wire/symbols.h"
#include "core/ids.h"
#include "core/time.h"
#include "sim/medium/arrival.h"
#include "sim/medium/channel_log.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"
#include "sim/medium/ways.h"

namespace ttf::sim::medium {

class Flights {
 public:
  // Has room for `room` flights from the beginning, and grows.
  Flights(const schedules::model::GlobalParameters& flexray, const FlexRayWays& ways, MediumQueue& queue,
          FramePool& pool, std::size_t room);
  Flights(const Flights&) = delete;
  Flights& operator=(const Flights&) = delete;

  // Null: the fate of frames is not logged.
  void set_log(ChannelLog* log) { log_ = log; }
  bool any(schedules::model::Channel channel) const { return aloft_[index_of(channel)] > 0; }

  // A flight is made in three steps: it takes off, is put wherever it arrives, and departs.
  FlightNumber take_off(NodeId sender, schedules::model::Channel channel, ChannelLog::Id logged);
  void put(FlightNumber number, NodeId receiver, const Arrival& arrival);
  void depart(FlightNumber number);

  // Reserves a number for something that may become a flight here: a signal on its way to a coupler, or a
  // flight of the fast way. A flight that is taken over keeps its place in the queue: its event is already
  // under way, or goes on from there.
  FlightNumber reserve();
  void give_back(FlightNumber number) { free_.push_back(number); }
  void take_over(FlightNumber number, const FlightPlace& place, ChannelLog::Id logged);
  void go_on(FlightNumber number);

  Stopover stop_over(const MediumEvent& event, TrueTime now);
  EventOrder next_arrival(MediumEvent& event) const;
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;

  // The node sends, so it cannot decode anything that arrives there meanwhile. For the log.
  void talk_over(NodeId node, schedules::model::Channel channel, TrueTime start, TrueTime end);
  // Drops the signals on their way to the node.
  void lose_receiver(NodeId node, schedules::model::Channel channel);
  // The sender falls silent; both instants are those at the begin of the way. A signal of the sender that has
  // not ended at a receiver when `silent` gets there ends when `ends` gets there, and is undecodable. A part
  // merged into another signal stays in it.
  void break_off(NodeId sender, schedules::model::Channel channel, const Way& way, TrueTime silent, TrueTime ends);

 private:
  // A signal on its way to one node on one channel.
  struct Pending {
    Arrival arrival;
    std::uint32_t id = 0;  // also the id of a flight's stop
    NodeId sender{};
    bool merged = false;  // consists of several signals
  };
  // The signals on their way to one node on one channel, in no order, without overlap. There is hardly ever
  // more than one, except for those that a fault delays.
  class Lane {
   public:
    Lane() { room_.reserve(kRoom); }
    auto begin() { return room_.begin(); }
    auto end() { return room_.end(); }
    auto begin() const { return room_.begin(); }
    auto end() const { return room_.end(); }
    void add(const Pending& pending) { room_.push_back(pending); }
    // Takes out the first that `is_meant`.
    template <class IsMeant> std::optional<Pending> take_out(IsMeant is_meant) {
      const auto found = std::find_if(room_.begin(), room_.end(), is_meant);
      if (found == room_.end()) return std::nullopt;
      const Pending taken = *found;
      *found = room_.back();
      room_.pop_back();
      return taken;
    }
    void clear() { room_.clear(); }

    // Notes a wake-up pattern, before it is added.
    void note_wakeup(const Arrival& pattern) {
      if (room_.empty()) wakeups_.clear();
      wakeups_.push_back({pattern.start - TrueTime{}, pattern.end - TrueTime{}});
    }
    // The wake-up patterns noted since the lane was empty; any overlap is of these.
    std::span<const bus::wire::WakeupPattern> wakeups() const { return wakeups_; }

   private:
    static constexpr std::size_t kRoom = 64;
    std::vector<Pending> room_;
    std::vector<bus::wire::WakeupPattern> wakeups_;
  };
  struct Stop {
    TrueTime end{};
    NodeId receiver = kNoNode;
    std::uint32_t id = 0;
  };
  struct Flight {
    FlightPlace place;
    ChannelLog::Id logged = ChannelLog::kNone;
    std::size_t size = 0, next = 0;  // stops, by (end, receiver) after its departure
    Stop last_received;              // the last end of its signal, wherever that is merged into another
  };

  void add_flights(std::size_t count);
  Arrival drawn_together(const Arrival& a, const Arrival& b, const Lane& at) const;
  void land(FlightNumber number);
  std::span<Stop> stops_of(FlightNumber number) { return std::span(stops_).subspan(number * most_stops_, most_stops_); }
  static std::size_t lane_of(NodeId node, schedules::model::Channel channel) {
    return 2 * index_of(node) + index_of(channel);
  }
  Lane& lane(NodeId node, schedules::model::Channel channel) { return lanes_[lane_of(node, channel)]; }

  const schedules::model::GlobalParameters flexray_;
  MediumQueue& queue_;
  FramePool& pool_;
  ChannelLog* log_ = nullptr;
  std::vector<Lane> lanes_;  // by NodeId and channel
  std::size_t most_stops_;   // one per node on the bus
  std::vector<Stop> stops_;  // most_stops_ for each flight
  std::vector<Flight> flights_;
  std::vector<FlightNumber> free_;
  std::array<int, 2> aloft_{};  // number of flights, by channel
  std::uint32_t next_id_ = 0;
};

}  // namespace ttf::sim::medium
