// Clear flights: what has its channel to itself, as nearly everything has, takes no more per receiver than its arrival.
//
// A flight is clear while its signal is as it left and is alone on its channel: then it stops wherever its way leads,
// and is noted at no receiver. When something else comes onto the channel, what it has still to do becomes a flight of
// the plain way (sim/medium/flights.h), whose laws it obeys, too; whoever meets it sees no difference.
//
// What leaves on both channels at once and is clear on both, for the same receivers, is one flight, which stops on A
// and then on B; or on both at once, where nothing else happens until its last stop. Tests compare
// both with the plain way: single stops in tests/sim/medium/clear_flights_test.cc, stops on both channels in whole drives
// in tests/sim/processes/unwanted_frames_test.cc.
#pragma once

#include <array>

#include "core/check.h"
#include "sim/medium/flights.h"

namespace ttf::sim::medium {

class ClearFlights {
 public:
  ClearFlights(const FlexRayWays& ways, Flights& flights, MediumQueue& queue, FramePool& pool)
      : ways_(ways), flights_(flights), queue_(queue), pool_(pool) {
    for (Flight& flight : room_) flight.number = flights.reserve();
  }
  ClearFlights(const ClearFlights&) = delete;
  ClearFlights& operator=(const ClearFlights&) = delete;

  // Null: nobody is told what becomes of frames on their way.
  void set_log(ChannelLog* log) { log_ = log; }
  // Whether one is on the channel. There is never one beside a flight of the plain way.
  bool any(schedules::model::Channel channel) const { return on_[index_of(channel)] != nullptr; }
  // Whether the event is one.
  bool is_one(const MediumEvent& event) const {
    return event.frame == room_[0].number || event.frame == room_[1].number;
  }

  // `left`: as it left, onto a channel without flights; `passed_over`: on its way, but no receiver.
  void depart(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over);
  // The same frame on both channels, which have no flights; `left` says channel A.
  void depart_on_both(NodeId sender, const Arrival& left, const Ways& ways);
  // Something else comes onto the channel: what is clear there is so no longer.
  void crowd(schedules::model::Channel channel);

  // Of an event that is one.
  Stopover stop_over(const MediumEvent& event, TrueTime now);
  EventOrder next_arrival(MediumEvent& event) const {
    const Flight& flight = flight_of(event);
    return next_stop(event, flight.place, flight.leg->receiver, flight.end_at(*flight.leg));
  }
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;

  // Whether it is one frame that stops on A and on B at once wherever it still goes; and when it will have done so.
  // Then stop_on_both() is both stops at the receiver that is next, and the frame is to be released on both.
  bool stops_on_both(const MediumEvent& event) const {
    if (!is_one(event)) return false;
    const Flight& flight = flight_of(event);
    return flight.both_channels && flight.place.channel == schedules::model::Channel::kA &&
           flight.left[0].signal == bus::ports::Signal::kFrame && flight.left[0].frame == flight.left[1].frame;
  }
  EventOrder last_arrival(const MediumEvent& event) const;
  struct StopOnBoth {
    NodeId receiver{};
    Arrival on_a;
    bool goes_on = false;
  };
  StopOnBoth stop_on_both(const MediumEvent& event);
  void release_on_both(const Arrival& on_a) { pool_.release(on_a.frame, 2); }

 private:
  struct Flight {
    FlightPlace place;
    FlightNumber number = 0;  // it stays until a flight takes it along into the plain way
    const Ways* ways = nullptr;
    const Leg* leg = nullptr;   // to the next stop; on both channels the legs are the same
    const Leg* last = nullptr;  // behind the last one
    NodeId passed_over = kNoNode;
    bool both_channels = false;
    std::array<Arrival, 2> left{};  // as it left, by channel

    TrueTime end_at(const Leg& on) const { return left[index_of(place.channel)].end + on.delay; }
    // The first leg from `from` on that leads to a receiver.
    const Leg* receiving(const Leg* from) const {
      while (from != last && from->receiver == passed_over) ++from;
      return from;
    }
    const Leg* first_leg() const { return receiving((*ways)[index_of(place.channel)].data()); }
  };
  Flight& flight_of(const MediumEvent& event) { return room_[event.frame == room_[0].number ? 0 : 1]; }
  const Flight& flight_of(const MediumEvent& event) const { return room_[event.frame == room_[0].number ? 0 : 1]; }
  Flight& take_off(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over);
  void join(Flight& on_a, const Arrival& left);
  void schedule(Flight& flight);
  void stopped_on_a(Flight& flight);
  void land(Flight& flight);
  void lay_out(FlightNumber number, const Flight& was, const Leg* from, const Arrival& left);

  const FlexRayWays& ways_;
  Flights& flights_;
  MediumQueue& queue_;
  FramePool& pool_;
  ChannelLog* log_ = nullptr;
  std::array<Flight, 2> room_;   // by the channel that it took off on first
  std::array<Flight*, 2> on_{};  // by channel; null where there is none
};

// --- what is done for every receiver

inline Stopover ClearFlights::stop_over(const MediumEvent& event, TrueTime now) {
  using schedules::model::Channel;
  Flight& flight = flight_of(event);
  Channel& channel = flight.place.channel;
  const Stopover here{flight.left[index_of(channel)].later_by(flight.leg->delay), true};
  TTF_CHECK(here.arrival->end == now, "an arrival of {} ns at {} ns", here.arrival->end.ns, now.ns);
  if (flight.both_channels) {
    channel = channel == Channel::kA ? Channel::kB : Channel::kA;
    if (channel == Channel::kB) {
      if (log_ != nullptr) stopped_on_a(flight);
      return here;
    }
  }
  flight.leg = flight.receiving(flight.leg + 1);
  if (flight.leg != flight.last) return here;
  land(flight);
  return {here.arrival, false};
}

}  // namespace ttf::sim::medium
