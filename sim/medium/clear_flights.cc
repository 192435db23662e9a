#include "sim/medium/clear_flights.h"

namespace ttf::sim::medium {
namespace {

using schedules::model::Channel;

Channel other(Channel channel) { return channel == Channel::kA ? Channel::kB : Channel::kA; }

}  // namespace

void ClearFlights::depart(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over) {
  // The same frame has left on channel A, and has not reached a receiver yet: they go together.
  Flight* const on_a = left.channel == Channel::kB && ways_.same_on_both() ? on_[index_of(Channel::kA)] : nullptr;
  if (on_a != nullptr && on_a->ways == &ways && on_a->passed_over == passed_over && on_a->place.sender == sender &&
      on_a->left[0].start == left.start && on_a->left[0].end == left.end && on_a->leg == on_a->first_leg())
    return join(*on_a, left);
  schedule(take_off(sender, left, ways, passed_over));
}

void ClearFlights::depart_on_both(NodeId sender, const Arrival& left, const Ways& ways) {
  Flight& flight = take_off(sender, left, ways, kNoNode);
  Arrival on_b = left;
  on_b.channel = Channel::kB;
  join(flight, on_b);
  schedule(flight);
}

ClearFlights::Flight& ClearFlights::take_off(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over) {
  const auto c = index_of(left.channel);
  Flight& flight = room_[c];
  flight.place = {sender, left.channel, 0};
  flight.ways = &ways;
  flight.last = ways[c].data() + ways[c].size();
  flight.passed_over = passed_over;
  flight.leg = flight.first_leg();
  flight.both_channels = false;
  flight.left[c] = left;
  on_[c] = &flight;
  return flight;
}

void ClearFlights::join(Flight& on_a, const Arrival& left) {
  const auto c = index_of(left.channel);
  on_a.both_channels = true;
  on_a.left[c] = left;
  on_[c] = &on_a;
}

void ClearFlights::schedule(Flight& flight) {
  MediumEvent event = event_of(flight.number);
  const EventOrder first = next_arrival(event);
  flight.place.sequence = queue_.schedule(first.time, first.phase, first.node, event, first.rank);
}

EventOrder ClearFlights::last_arrival(const MediumEvent& event) const {
  const Flight& flight = flight_of(event);
  const Leg* last = flight.last - 1;
  while (last != flight.leg && last->receiver == flight.passed_over) --last;
  FlightPlace on_b = flight.place;
  on_b.channel = Channel::kB;
  return order_of(on_b, last->receiver, flight.left[index_of(Channel::kB)].end + last->delay);
}

ClearFlights::StopOnBoth ClearFlights::stop_on_both(const MediumEvent& event) {
  Flight& flight = flight_of(event);
  const Leg leg = *flight.leg;
  flight.leg = flight.receiving(flight.leg + 1);
  const StopOnBoth stop{leg.receiver, flight.left[0].later_by(leg.delay), flight.leg != flight.last};
  if (!stop.goes_on) land(flight);
  return stop;
}

// On both channels, the log receives the end on A where that is, one stop before the end on B.
void ClearFlights::stopped_on_a(Flight& flight) {
  if (flight.receiving(flight.leg + 1) != flight.last) return;
  Arrival& left = flight.left[index_of(Channel::kA)];
  log_->arrived(left.logged);
  left.logged = ChannelLog::kNone;
}

// Lands after the last stop; on both channels, that was on B.
void ClearFlights::land(Flight& flight) {
  const Channel last = flight.both_channels ? Channel::kB : flight.place.channel;
  if (flight.both_channels) on_[index_of(Channel::kA)] = nullptr;
  on_[index_of(last)] = nullptr;
  if (log_ != nullptr) log_->arrived(flight.left[index_of(last)].logged);
}

bool ClearFlights::carrier(NodeId node, Channel channel, TrueTime now) const {
  const Flight& flight = *on_[index_of(channel)];
  // On both channels, A has already been at B's next stop.
  const bool ahead = flight.both_channels && channel == Channel::kA && flight.place.channel == Channel::kB;
  for (const Leg* leg = flight.leg + (ahead ? 1 : 0); leg != flight.last; ++leg)
    if (leg->receiver == node)
      return node != flight.passed_over && flight.left[index_of(channel)].start + leg->delay <= now;
  return false;
}

void ClearFlights::crowd(Channel channel) {
  if (!any(channel)) return;
  Flight& was = *on_[index_of(channel)];
  const Channel first = was.place.channel, second = other(first);
  on_[index_of(first)] = nullptr;
  const Arrival& on_first = was.left[index_of(first)];
  flights_.take_over(was.number, was.place, on_first.logged);
  lay_out(was.number, was, was.leg, on_first);
  was.number = flights_.reserve();
  if (!was.both_channels) return;
  // The rest on the other channel becomes a flight of its own. B follows A from stop to stop.
  on_[index_of(second)] = nullptr;
  const Arrival& on_second = was.left[index_of(second)];
  const FlightNumber number = flights_.reserve();
  flights_.take_over(number, {was.place.sender, second, was.place.sequence}, on_second.logged);
  lay_out(number, was, was.leg + (second == Channel::kA ? 1 : 0), on_second);
  flights_.go_on(number);
}

// Notes the signal, which left as `left`, wherever it arrives from that leg on.
void ClearFlights::lay_out(FlightNumber number, const Flight& was, const Leg* from, const Arrival& left) {
  for (const Leg* leg = from; leg != was.last; ++leg)
    if (leg->receiver != was.passed_over) flights_.put(number, leg->receiver, left.later_by(leg->delay));
}

}  // namespace ttf::sim::medium
