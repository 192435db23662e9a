#include "sim/medium/flights.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

bool overlap(const Arrival& a, const Arrival& b) { return a.start < b.end && b.start < a.end; }

}  // namespace

Flights::Flights(const schedules::model::GlobalParameters& flexray, const FlexRayWays& ways, MediumQueue& queue,
                 FramePool& pool, std::size_t room)
    : flexray_(flexray), queue_(queue), pool_(pool), lanes_(2 * ways.nodes()), most_stops_(ways.nodes_on_bus()) {
  add_flights(room);
}

// Merges two signals, without their frames. Symbols of one kind may remain one.
Arrival Flights::drawn_together(const Arrival& a, const Arrival& b, const Lane& at) const {
  const auto both = [&](Signal signal) { return a.signal == signal && b.signal == signal; };
  Arrival one = a;
  one.logged = ChannelLog::kNone;
  one.signal = Signal::kUndecodable;
  if (both(Signal::kCas)) one.signal = Signal::kCas;
  if (both(Signal::kWakeup) && bus::wire::wakes(flexray_, at.wakeups())) one.signal = Signal::kWakeup;
  one.start = std::min(a.start, b.start);
  one.end = std::max(a.end, b.end);
  return one;
}

void Flights::add_flights(std::size_t count) {
  const std::size_t before = flights_.size();
  flights_.resize(before + count);
  stops_.resize(flights_.size() * most_stops_);
  free_.reserve(flights_.size());
  for (std::size_t f = flights_.size(); f-- > before;) free_.push_back(static_cast<FlightNumber>(f));
}

FlightNumber Flights::reserve() {
  if (free_.empty()) add_flights(flights_.size());
  const FlightNumber number = free_.back();
  free_.pop_back();
  return number;
}

FlightNumber Flights::take_off(NodeId sender, Channel channel, ChannelLog::Id logged) {
  const FlightNumber number = reserve();
  take_over(number, {sender, channel, 0}, logged);
  return number;
}

void Flights::take_over(FlightNumber number, const FlightPlace& place, ChannelLog::Id logged) {
  ++aloft_[index_of(place.channel)];
  flights_[number] = {place, logged, 0, 0, {}};
}

// Adds an arrival, merged with all that it overlaps. It gets a stop, unless a signal already on its way ends
// last and has one.
void Flights::put(FlightNumber number, NodeId receiver, const Arrival& arrival) {
  Flight& flight = flights_[number];
  Lane& pending = lane(receiver, arrival.channel);
  if (arrival.signal == Signal::kWakeup) pending.note_wakeup(arrival);
  Pending made{arrival, next_id_++, flight.place.sender, false};
  const Stop own{arrival.end, receiver, made.id};
  if (flight.last_received.receiver == kNoNode || own.end > flight.last_received.end) flight.last_received = own;
  // A merged signal may reach others that it did not reach before.
  const auto is_reached = [&](const Pending& other) { return overlap(other.arrival, made.arrival); };
  while (const std::optional<Pending> other = pending.take_out(is_reached)) {
    release(pool_, other->arrival);
    release(pool_, made.arrival);
    if (log_ != nullptr) log_->lost(made.arrival.logged), log_->lost(other->arrival.logged);
    if (other->arrival.end >= made.arrival.end) made.id = other->id;  // else the other's stop finds nothing
    made.arrival = drawn_together(made.arrival, other->arrival, pending);
    made.merged = true;
  }
  pending.add(made);
  if (made.id == own.id) stops_of(number)[flight.size++] = own;
}

void Flights::depart(FlightNumber number) {
  Flight& flight = flights_[number];
  // Merged everywhere, it has no stop of its own. It lands at its end all the same, for the log: it may still
  // break off.
  if (flight.size == 0 && flight.logged != ChannelLog::kNone && flight.last_received.receiver != kNoNode)
    stops_of(number)[flight.size++] = flight.last_received;
  if (flight.size == 0) return land(number);
  // In the order of the way, unless a disturbance changed a signal on its last metre.
  const auto by_end = [](const Stop& a, const Stop& b) {
    return a.end != b.end ? a.end < b.end : a.receiver < b.receiver;
  };
  const std::span<Stop> stops = stops_of(number).first(flight.size);
  if (!std::is_sorted(stops.begin(), stops.end(), by_end)) std::sort(stops.begin(), stops.end(), by_end);
  MediumEvent event = event_of(number);
  const EventOrder first = next_arrival(event);
  flight.place.sequence = queue_.schedule(first.time, first.phase, first.node, event, first.rank);
}

void Flights::go_on(FlightNumber number) {
  if (flights_[number].size == 0) return land(number);
  MediumEvent event = event_of(number);
  const EventOrder next = next_arrival(event);
  queue_.go_on(next, event);
}

void Flights::land(FlightNumber number) {
  const Flight& flight = flights_[number];
  --aloft_[index_of(flight.place.channel)];
  give_back(number);
  if (log_ != nullptr) log_->arrived(flight.logged);
}

EventOrder Flights::next_arrival(MediumEvent& event) const {
  const Flight& flight = flights_[event.frame];
  const Stop& stop = stops_[event.frame * most_stops_ + flight.next];
  return next_stop(event, flight.place, stop.receiver, stop.end);
}

Stopover Flights::stop_over(const MediumEvent& event, TrueTime now) {
  Flight& flight = flights_[event.frame];
  const Stop stop = stops_of(event.frame)[flight.next++];
  Stopover here;
  here.goes_on = flight.next < flight.size;
  if (!here.goes_on) land(event.frame);
  Lane& pending = lane(stop.receiver, flight.place.channel);
  const auto found = pending.take_out([&](const Pending& one) { return one.id == stop.id; });
  if (!found) return here;
  TTF_CHECK(found->arrival.end == now, "an arrival of {} ns at {} ns", found->arrival.end.ns, now.ns);
  here.arrival = found->arrival;
  return here;
}

bool Flights::carrier(NodeId node, Channel channel, TrueTime now) const {
  const Lane& pending = lanes_[lane_of(node, channel)];
  return std::any_of(pending.begin(), pending.end(), [&](const Pending& one) { return one.arrival.start <= now; });
}

void Flights::talk_over(NodeId node, Channel channel, TrueTime start, TrueTime end) {
  for (Pending& one : lane(node, channel)) {
    if (one.arrival.end <= start || end <= one.arrival.start) continue;
    log_->lost(one.arrival.logged);
    one.arrival.logged = ChannelLog::kNone;
  }
}

void Flights::lose_receiver(NodeId node, Channel channel) {
  Lane& incoming = lane(node, channel);
  for (const Pending& one : incoming) release(pool_, one.arrival);
  incoming.clear();
}

void Flights::break_off(NodeId sender, Channel channel, const Way& way, TrueTime silent, TrueTime ends) {
  std::optional<FlightNumber> rests;  // a flight for all the rests
  for (const Leg& leg : way) {
    const TrueTime falls_silent = silent + leg.delay, rest_ends = ends + leg.delay;
    const auto breaks_off = [&](const Pending& one) {
      const bool is_rest = one.arrival.signal == Signal::kUndecodable && one.arrival.end == rest_ends;
      return one.sender == sender && !one.merged && !is_rest && one.arrival.end > falls_silent;
    };
    while (const std::optional<Pending> broken = lane(leg.receiver, channel).take_out(breaks_off)) {
      release(pool_, broken->arrival);
      if (broken->arrival.start >= rest_ends) continue;
      Arrival rest = broken->arrival;
      rest.signal = Signal::kUndecodable;
      rest.end = rest_ends;
      rest.logged = ChannelLog::kNone;
      if (!rests) rests = take_off(sender, channel, ChannelLog::kNone);
      put(*rests, leg.receiver, rest);
    }
  }
  if (rests) depart(*rests);
}

}  // namespace ttf::sim::medium
