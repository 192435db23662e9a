// Clear flights: what has its channel to itself, as nearly everything has, takes no more per receiver than its arrival.
#include "core/check.h"
#include "sim/medium/flexray_medium.h"

namespace ttf::sim::medium {
namespace {

using schedules::model::Channel;

Channel other(Channel channel) { return channel == Channel::kA ? Channel::kB : Channel::kA; }

// The first leg from `leg` on that leads to a receiver.
template <class Leg> const Leg* receiving(const Leg* leg, const Leg* last, NodeId passed_over) {
  while (leg != last && leg->receiver == passed_over) ++leg;
  return leg;
}

}  // namespace

const FlexRayMedium::Leg* FlexRayMedium::first_leg(const Flight& flight) {
  return receiving((*flight.ways)[index_of(flight.channel)].data(), flight.last, flight.passed_over);
}

void FlexRayMedium::depart_clear(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over) {
  // The same has left on channel A, and has not reached anybody yet: they go together.
  Flight* const on_a = left.channel == Channel::kB && same_receivers_ ? clear_[index_of(Channel::kA)] : nullptr;
  if (on_a != nullptr && on_a->ways == &ways && on_a->passed_over == passed_over && on_a->sender == sender &&
      on_a->left[0].start == left.start && on_a->left[0].end == left.end && on_a->leg == first_leg(*on_a))
    return join(*on_a, left);
  schedule(take_off_clear(sender, left, ways, passed_over));
}

FlexRayMedium::Flight& FlexRayMedium::take_off_clear(NodeId sender, const Arrival& left, const Ways& ways,
                                                     NodeId passed_over) {
  const auto c = index_of(left.channel);
  Flight& flight = take_off(sender, left.channel, left.logged);
  flight.ways = &ways;
  flight.passed_over = passed_over;
  flight.both_channels = false;
  flight.left[c] = left;
  flight.last = ways[c].data() + ways[c].size();
  flight.leg = first_leg(flight);
  clear_[c] = &flight;
  return flight;
}

void FlexRayMedium::join(Flight& on_a, const Arrival& left) {
  const auto c = index_of(left.channel);
  on_a.both_channels = true;
  on_a.left[c] = left;
  clear_[c] = &on_a;
  ++aloft_[c];
}

void FlexRayMedium::transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                                     TrueTime end) {
  const Ways& ways = ways_[index_of(sender)];
  const int receivers = static_cast<int>(ways[0].size());
  if (!is_clear() || receivers == 0) {
    transmit(sender, transmission, start, end);
    return transmit(sender, bus::ports::on_b(transmission), start, end);
  }
  const std::uint32_t frame = pool_.put_content(transmission.content, 2 * receivers);
  Arrival left{start, end, frame, Channel::kA, bus::ports::Signal::kFrame, ChannelLog::kNone};
  Flight& flight = take_off_clear(sender, left, ways, kNoNode);
  left.channel = Channel::kB;
  join(flight, left);
  told_on_both(sender, start, end);
  schedule(flight);
}

void FlexRayMedium::told_on_both(NodeId sender, TrueTime start, TrueTime end) {
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    busy_[index_of(channel)] += end - start;
    sent_until_[lane_of(sender, channel)] = end;
  }
}

EventOrder FlexRayMedium::last_arrival(const MediumEvent& event) const {
  const Flight& flight = flights_[event.frame];
  const Leg* last = flight.last - 1;
  while (last != flight.leg && last->receiver == flight.passed_over) --last;
  return order_of(flight, Channel::kB, *last);
}

FlexRayMedium::Passage FlexRayMedium::pass_on_both(const MediumEvent& event) {
  Flight& flight = flights_[event.frame];
  const Leg leg = *flight.leg;
  flight.leg = receiving(flight.leg + 1, flight.last, flight.passed_over);
  const Passage passage{leg.receiver, after(flight.left[0], leg.delay), flight.leg != flight.last};
  if (!passage.goes_on) land_clear(flight);
  return passage;
}

// On both channels: the log hears of the end of what is on A where that ends, one stop before what is on B.
void FlexRayMedium::stopped_on_a(Flight& flight) {
  if (receiving(flight.leg + 1, flight.last, flight.passed_over) != flight.last) return;
  log_->arrived(flight.left[index_of(Channel::kA)].logged);
  flight.left[index_of(Channel::kA)].logged = ChannelLog::kNone;
}

// From its last stop: on both channels, it is on A again.
void FlexRayMedium::land_clear(Flight& flight) {
  if (flight.both_channels) {
    flight.logged = flight.left[index_of(Channel::kB)].logged;
    clear_[index_of(Channel::kB)] = nullptr;
    --aloft_[index_of(Channel::kB)];
  }
  clear_[index_of(flight.channel)] = nullptr;
  land(flight);
}

bool FlexRayMedium::carrier_of_clear(const Flight& flight, NodeId node, Channel channel, TrueTime now) const {
  // On both channels, A has been where B stops next.
  const bool ahead = flight.both_channels && channel == Channel::kA && flight.channel == Channel::kB;
  for (const Leg* leg = flight.leg + (ahead ? 1 : 0); leg != flight.last; ++leg)
    if (leg->receiver == node)
      return node != flight.passed_over && flight.left[index_of(channel)].start + leg->delay <= now;
  return false;
}

void FlexRayMedium::crowd(Channel channel) {
  Flight* const was_clear = clear_[index_of(channel)];
  if (was_clear == nullptr) return;
  const Flight clear = *was_clear;
  // The event that it has in the queue remains its own.
  clear_[index_of(clear.channel)] = nullptr;
  was_clear->ways = nullptr;
  was_clear->size = was_clear->next = 0;
  was_clear->logged = clear.left[index_of(clear.channel)].logged;
  lay_out(*was_clear, {clear.leg, clear.last}, clear.passed_over, clear.left[index_of(clear.channel)]);
  if (!clear.both_channels) return;
  // What it has still to do on the other channel becomes a flight of its own. B follows A from stop to stop.
  const Channel second = other(clear.channel);
  clear_[index_of(second)] = nullptr;
  --aloft_[index_of(second)];
  Flight& flight = take_off(clear.sender, second, clear.left[index_of(second)].logged);
  lay_out(flight, {clear.leg + (second == Channel::kA ? 1 : 0), clear.last}, clear.passed_over,
          clear.left[index_of(second)]);
  if (flight.size == 0) return land(flight);
  flight.sequence = clear.sequence;
  MediumEvent event = event_of(flight);
  const EventOrder next = next_arrival(event);
  queue_.go_on(next, event);
}

void FlexRayMedium::lay_out(Flight& flight, std::span<const Leg> way, NodeId passed_over, const Arrival& left) {
  for (const Leg& leg : way)
    if (leg.receiver != passed_over) put(flight, leg.receiver, after(left, leg.delay));
}

}  // namespace ttf::sim::medium
