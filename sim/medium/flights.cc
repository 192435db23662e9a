// Flights: one signal on its way to all who hear it, from its departure to its last stop, and what becomes of it where
// another one arrives at the same time.
#include <algorithm>

#include "sim/medium/flexray_medium.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

bool overlap(const FlexRayMedium::Arrival& a, const FlexRayMedium::Arrival& b) {
  return a.start < b.end && b.start < a.end;
}

}  // namespace

// Flights move: nobody holds on to one across this.
void FlexRayMedium::add_flights(std::size_t count) {
  const std::size_t before = flights_.size();
  std::array<std::size_t, 2> clear{};
  for (std::size_t c = 0; c < clear.size(); ++c)
    if (clear_[c] != nullptr) clear[c] = static_cast<std::size_t>(clear_[c] - flights_.data());
  flights_.resize(before + count);
  stops_.resize(flights_.size() * most_stops_);
  free_flights_.reserve(flights_.size());
  for (std::size_t f = flights_.size(); f-- > before;) free_flights_.push_back(static_cast<std::uint32_t>(f));
  for (std::size_t c = 0; c < clear.size(); ++c)
    if (clear_[c] != nullptr) clear_[c] = &flights_[clear[c]];
}

FlexRayMedium::Flight& FlexRayMedium::take_off(NodeId sender, Channel channel, ChannelLog::Id logged) {
  if (free_flights_.empty()) add_flights(flights_.size());
  Flight& flight = flights_[free_flights_.back()];
  free_flights_.pop_back();
  ++aloft_[index_of(channel)];
  flight.size = flight.next = 0;
  flight.last_heard = {TrueTime{}, kNoNode, 0};
  flight.logged = logged;
  flight.sender = sender;
  flight.channel = channel;
  return flight;
}

void FlexRayMedium::land(Flight& flight) {
  --aloft_[index_of(flight.channel)];
  flight.ways = nullptr;
  free_flights_.push_back(static_cast<std::uint32_t>(&flight - flights_.data()));
  if (log_ != nullptr) log_->arrived(flight.logged);
}

// What arrives there, together with what it overlaps with: a stop more, unless something that is on its way already
// ends last and has one.
void FlexRayMedium::put(Flight& flight, NodeId receiver, const Arrival& arrival) {
  Lane& pending = lane(receiver, arrival.channel);
  Pending made{arrival, next_id_++, flight.sender, false};
  const Stop own{arrival.end, receiver, made.id};
  if (flight.last_heard.receiver == kNoNode || own.end > flight.last_heard.end) flight.last_heard = own;
  for (std::size_t i = 0; i < pending.size();) {
    const Pending other = pending[i];
    if (!overlap(other.arrival, made.arrival)) {
      ++i;
      continue;
    }
    // Two become one.
    const bool cas = other.arrival.signal == Signal::kCas && made.arrival.signal == Signal::kCas;
    release(other.arrival);
    release(made.arrival);
    if (log_ != nullptr) log_->lost(made.arrival.logged), log_->lost(other.arrival.logged);
    if (other.arrival.end >= made.arrival.end) made.id = other.id;  // else the other's stop will find nothing
    made.arrival.logged = ChannelLog::kNone;
    made.arrival.signal = cas ? Signal::kCas : Signal::kUndecodable;
    made.arrival.start = std::min(made.arrival.start, other.arrival.start);
    made.arrival.end = std::max(made.arrival.end, other.arrival.end);
    made.merged = true;
    pending.take_out(i);
    i = 0;  // grown, it may reach what it did not reach before
  }
  pending.add(made);
  if (made.id == own.id) stops_of(flight)[flight.size++] = own;
}

void FlexRayMedium::depart(Flight& flight) {
  const auto by_end = [](const Stop& a, const Stop& b) {
    return a.end != b.end ? a.end < b.end : a.receiver < b.receiver;
  };
  // Drawn into others everywhere: it has no stop. The log hears of it when it is over, as of any: it may break off.
  if (flight.size == 0 && flight.logged != ChannelLog::kNone && flight.last_heard.receiver != kNoNode)
    stops_of(flight)[flight.size++] = flight.last_heard;
  if (flight.size == 0) return land(flight);
  // As the way is, unless something has changed a signal on its last metre.
  const std::span<Stop> stops = stops_of(flight).first(flight.size);
  if (!std::is_sorted(stops.begin(), stops.end(), by_end)) std::sort(stops.begin(), stops.end(), by_end);
  schedule(flight);
}

MediumEvent FlexRayMedium::event_of(const Flight& flight) const {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kFlexRayArrival;
  event.frame = static_cast<std::uint32_t>(&flight - flights_.data());
  return event;
}

void FlexRayMedium::schedule(Flight& flight) {
  MediumEvent event = event_of(flight);
  const EventOrder first = next_arrival(event);
  flight.sequence = queue_.schedule(first.time, first.phase, first.node, event, first.rank);
}

}  // namespace ttf::sim::medium
