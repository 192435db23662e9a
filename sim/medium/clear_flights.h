// Clear flights: a signal alone on its channel, as most are, costs no more per receiver than its arrival.
//
// A flight is clear while its signal is unchanged and alone on its channel. It stops along its whole way,
// without a note at any receiver. When another signal comes onto the channel, the rest of the flight becomes
// one of the plain way (sim/medium/flights.h). Both kinds obey the same laws, so a receiver sees no difference.
//
// A signal that leaves on both channels at once, and is clear on both for the same receivers, is one flight. It
// stops on A and then on B; or on both at once, if nothing else happens until its last stop. Tests compare both with
// the plain way: single stops in tests/sim/medium/clear_flights_test.cc, stops on both channels in whole drives in
// tests/sim/processes/unwanted_frames_test.cc.
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

  // Null: the fate of frames is not logged.
  void set_log(ChannelLog* log) { log_ = log; }
  // Returns whether a clear flight is on the channel. It never shares the channel with a flight of the plain way.
  bool any(schedules::model::Channel channel) const { return on_[index_of(channel)] != nullptr; }
  // Returns whether the event is one of a clear flight.
  bool is_one(const MediumEvent& event) const {
    return event.frame == room_[0].number || event.frame == room_[1].number;
  }

  // Starts a flight onto a channel without flights. `left` is the signal as it left. `passed_over` is on its
  // way, but no receiver.
  void depart(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over);
  // Starts a flight of one frame on both channels, which have no flights; `left` says channel A.
  void depart_on_both(NodeId sender, const Arrival& left, const Ways& ways);
  // Makes the channel's clear flight plain, because another signal comes onto the channel.
  void crowd(schedules::model::Channel channel);

  // For an event of a clear flight.
  Stopover stop_over(const MediumEvent& event, TrueTime now);
  EventOrder next_arrival(MediumEvent& event) const {
    const Flight& flight = flight_of(event);
    return next_stop(event, flight.place, flight.leg->receiver, flight.end_at(*flight.leg));
  }
  bool carrier(NodeId node, schedules::model::Channel channel, TrueTime now) const;

  // Returns whether the event is of one frame that stops on A and B at once at all its remaining receivers;
  // last_arrival() is its last stop. Then stop_on_both() makes both stops at the next receiver, and the frame
  // is to be released on both.
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
    FlightNumber number = 0;  // kept until the flight becomes plain
    const Ways* ways = nullptr;
    const Leg* leg = nullptr;   // to the next stop; both channels have the same legs
    const Leg* last = nullptr;  // one past the last leg
    NodeId passed_over = kNoNode;
    bool both_channels = false;
    std::array<Arrival, 2> left{};  // as it left, by channel

    TrueTime end_at(const Leg& on) const { return left[index_of(place.channel)].end + on.delay; }
    // Returns the first leg from `from` on that leads to a receiver.
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
  std::array<Flight, 2> room_;   // by the channel of the first take-off
  std::array<Flight*, 2> on_{};  // by channel; null without one
};

// --- the work for every receiver

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
