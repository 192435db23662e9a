// Clear flights: what has its channel to itself, as nearly everything has, takes no more per receiver than its arrival.
#include "core/check.h"
#include "sim/flexray_medium.h"

namespace ttf::sim {
namespace {

using schedules::Channel;

Channel other(Channel channel) { return channel == Channel::kA ? Channel::kB : Channel::kA; }

// The first leg from `leg` on that leads to a receiver.
template <class Leg>
const Leg* receiving(const Leg* leg, const Leg* last, NodeId passed_over) {
  while (leg != last && leg->receiver == passed_over) ++leg;
  return leg;
}

}  // namespace

const FlexRayMedium::Leg* FlexRayMedium::first_leg(const Flight& flight) {
  return receiving((*flight.ways)[index_of(flight.channel)].data(), flight.last, flight.passed_over);
}

void FlexRayMedium::depart_clear(NodeId sender, const Arrival& left, const Ways& ways, NodeId passed_over) {
  const auto c = index_of(left.channel);
  // The same has left on channel A, and has not reached anybody yet: they go together.
  Flight* const on_a = left.channel == Channel::kB && same_receivers_ ? clear_[index_of(Channel::kA)] : nullptr;
  if (on_a != nullptr && on_a->ways == &ways && on_a->passed_over == passed_over && on_a->sender == sender &&
      on_a->left[0].start == left.start && on_a->left[0].end == left.end && on_a->leg == first_leg(*on_a)) {
    on_a->both_channels = true;
    on_a->left[c] = left;
    clear_[c] = on_a;
    ++aloft_[c];
    return;
  }
  Flight& flight = take_off(sender, left.channel, left.logged);
  flight.ways = &ways;
  flight.passed_over = passed_over;
  flight.both_channels = false;
  flight.left[c] = left;
  flight.last = ways[c].data() + ways[c].size();
  flight.leg = first_leg(flight);
  clear_[c] = &flight;
  schedule(flight);
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

}  // namespace ttf::sim
