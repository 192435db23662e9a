#include "sim/engine/engine.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::sim::engine {
namespace {

constexpr Microticks kUnknown{std::numeric_limits<std::int64_t>::min()};

}  // namespace

const Engine::Span& Engine::Clock::span(TrueTime start, TrueTime end) {
  if (start != started_ || end != ended_) {
    started_ = start;
    ended_ = end;
    span_ = {oscillator_.ticks_at(start), oscillator_.ticks_at(end)};
  }
  return span_;
}

Engine::Engine(const schedules::model::Cluster& cluster, std::size_t others)
    : cluster_(cluster), queue_(medium::FlexRayMedium::kMostPending + others),
      pool_(medium::FlexRayMedium::kMostPending + others), medium_(cluster, queue_, pool_) {
  seats_.reserve(cluster.nodes.size());
  next_.reserve(cluster.nodes.size());
}

void Engine::seat(const timebase::Oscillator& oscillator, std::optional<TrueTime> power_on) {
  TTF_CHECK(seats_.size() < cluster_.nodes.size(), "a clock for more than {} nodes", seats_.size());
  TTF_CHECK(!power_on || *power_on >= TrueTime{}, "power-on at {} ns", power_on->ns);
  seats_.push_back({Clock(oscillator), !power_on, TrueTime{} - Duration{1}, kUnknown});
  next_.push_back(kNever<TrueTime>);
  if (power_on) set_next(seats_.size() - 1, *power_on);
}

void Engine::seat_guardians(const std::function<timebase::Oscillator(schedules::model::Channel)>& crystal,
                            const std::optional<FirstCycle>& first) {
  for (const schedules::model::Channel channel : {schedules::model::Channel::kA, schedules::model::Channel::kB}) {
    if (!medium::StarCoupler::needed(cluster_, channel)) continue;
    TTF_CHECK(cluster_.topology == schedules::model::Topology::kStar, "guardians for {}, which is no star",
              cluster_.name);
    auto& coupler = couplers_[index_of(channel)];
    coupler = std::make_unique<medium::StarCoupler>(cluster_, channel, crystal(channel));
    medium_.set_coupler(channel, coupler.get());
    if (first) coupler->start_integrated(first->start, first->length);
  }
}

void Engine::set_disturbance(medium::Disturbance* disturbance) {
  disturbance_ = disturbance;
  medium_.set_disturbance(disturbance);
  disturbs_cans(disturbance);
}

void Engine::power_off(NodeId node) {
  const std::size_t n = index_of(node);
  set_next(n, kNever<TrueTime>);
  seats_[n].next = kUnknown;
  if (!seats_[n].powered) return;
  seats_[n].powered = false;
  seats_[n].since = now_;
  stop(n);
  medium_.power_off(node, now_);
}

void Engine::power_on(NodeId node, TrueTime at) {
  TTF_CHECK(at >= now_, "power-on at {} ns, it is {} ns", at.ns, now_.ns);
  power_off(node);
  const std::size_t n = index_of(node);
  set_next(n, std::max(at, seats_[n].since + Duration{1}));
}

void Engine::change_drift(NodeId node, std::int64_t ppb) {
  const std::size_t n = index_of(node);
  seats_[n].clock.change_drift(now_, ppb);
  seats_[n].next = kUnknown;
  if (!seats_[n].powered) return;
  drifts(n);
  refresh(n);
}

void Engine::emit(const medium::Leaving& signal, std::optional<NodeId> source) { medium_.emit(signal, source); }

void Engine::set_next_event(std::size_t node, Microticks next) {
  seats_[node].next = next;
  set_next(node, next_time(seats_[node]));
}

TrueTime Engine::next_time(const Seat& seat) const {
  return seat.next == kNever<Microticks> ? kNever<TrueTime>
                                         : std::max(now_, seat.clock.oscillator().time_of(seat.next));
}

// Keeps `earliest_` the node that is due first, the lowest of several.
void Engine::set_next(std::size_t node, TrueTime time) {
  const TrueTime before = next_[node];
  next_[node] = time;
  if (node == earliest_) {
    if (time > before) {
      std::size_t earliest = 0;
      for (std::size_t n = 1; n < next_.size(); ++n) earliest = next_[n] < next_[earliest] ? n : earliest;
      earliest_ = earliest;
    }
  } else if (time < next_[earliest_] || (time == next_[earliest_] && node < earliest_)) {
    earliest_ = node;
  }
}

void Engine::run_until(TrueTime end) {
  until_ = end;
  while (true) {
    const bool node_is_due = queue_.empty() || next_of_nodes() < queue_.next();
    const TrueTime time = node_is_due ? next_[earliest_] : queue_.next().time;
    if (disturbance_ != nullptr && disturbance_->next() < time) {
      if (disturbance_->next() > end) break;
      now_ = std::max(now_, disturbance_->next());
      disturbance_->act(now_);
      continue;
    }
    if (time > end || time == kNever<TrueTime>) break;
    TTF_CHECK(time >= now_, "time goes back from {} to {} ns", now_.ns, time.ns);
    now_ = time;
    if (node_is_due) {
      step(earliest_);
    } else {
      const medium::MediumEvent event = queue_.pop();
      if (event.kind == medium::MediumEvent::Kind::kFlexRayArrival)
        go_along(event);
      else
        happen(event);
    }
  }
  now_ = std::max(now_, end);
}

// Does all work of the node until another event comes next: often frame after frame.
void Engine::step(std::size_t node) {
  Seat& seat = seats_[node];
  Microticks at = ticks(node);
  if (!seat.powered) {
    start(node, at);
    seat.powered = true;
    seat.since = now_;
  }
  set_next(node, kNever<TrueTime>);
  while (true) {
    advance(node, at);
    seat.next = next_event(node);
    const TrueTime next = next_time(seat);
    if (!comes_next({next, medium::Phase::kNode, static_cast<std::uint8_t>(node), 0, 0})) return set_next(node, next);
    at = next > now_ ? seat.next : ticks(node);
    now_ = next;
  }
}

// Delivers a signal at its next receiver. Returns whether it goes on from there.
inline bool Engine::make_stop(const medium::MediumEvent& event) {
  const auto [arrival, goes_on] = medium_.stop_over(event, now_);
  if (!arrival) return goes_on;
  Seat& seat = seats_[event.node];
  if (seat.powered) {
    receive(event.node, reception_of(seat, *arrival));
    refresh(event.node);
  }
  medium_.release(*arrival);
  return goes_on;
}

// Delivers a signal on both channels at once. Most signals reach their last receiver before any other event, so
// this goes on to the last one, or until a node has to act first. Returns whether the signal goes on from there.
bool Engine::make_stop_on_both(const medium::MediumEvent& event) {
  medium::ClearFlights& clear = medium_.clear_flights();
  const TrueTime earliest = next_[earliest_];
  while (true) {
    const auto [receiver, on_a, goes_on] = clear.stop_on_both(event);
    now_ = on_a.end;
    const std::size_t node = index_of(receiver);
    Seat& seat = seats_[node];
    if (seat.powered && receive_on_both(node, reception_of(seat, on_a))) refresh(node);
    clear.release_on_both(on_a);
    if (!goes_on || next_[earliest_] != earliest) return goes_on;
  }
}

// Follows a signal from receiver to receiver, as long as no other event comes between.
void Engine::go_along(medium::MediumEvent event) {
  const medium::ClearFlights& clear = medium_.clear_flights();
  while (true) {
    const bool on_both = clear.stops_on_both(event) && comes_next(clear.last_arrival(event));
    const bool goes_on = on_both ? make_stop_on_both(event) : make_stop(event);
    if (!goes_on) return;
    const medium::EventOrder next = medium_.next_arrival(event);
    if (!comes_next(next)) return queue_.go_on(next, event);
    now_ = next.time;
  }
}

bus::ports::Reception Engine::reception_of(Seat& seat, const medium::Arrival& arrival) {
  const auto [start, end] = seat.clock.span(arrival.start, arrival.end);
  // The rest of a signal that was on its way at power-on.
  if (arrival.start < seat.since)
    return {arrival.channel, bus::ports::Signal::kUndecodable, seat.clock.oscillator().ticks_at(seat.since), end, {}};
  const bool is_frame = arrival.signal == bus::ports::Signal::kFrame;
  return {arrival.channel, arrival.signal, start, end, is_frame ? medium_.frame(arrival) : bus::wire::DecodedFrame{}};
}

// Returns whether the signal leaves now and arrives before anything else on FlexRay happens to its receivers;
// tasks and CANs do not matter. There must be a receiver. The last leg is the longest.
inline bool Engine::arrives_alone(std::span<const medium::Leg> way, TrueTime start, TrueTime end) const {
  return start == now_ && medium_.is_clear() && !way.empty() && end + way.back().delay <= until_;
}

// A signal known to every receiver need not arrive.
void Engine::transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                              TrueTime end) {
  const std::span<const medium::Leg> way = medium_.way_from(sender);
  bus::ports::Reception reception{transmission.channel, transmission.signal, {}, {}, transmission.content};
  const auto received_during = [&](const Span& span) -> const bus::ports::Reception& {
    reception.start = span.start;
    reception.end = span.end;
    return reception;
  };
  const auto is_known_there = [&](const medium::Leg& leg) {
    Seat& seat = seats_[index_of(leg.receiver)];
    return seat.powered &&
           is_known(index_of(leg.receiver), received_during(seat.clock.span(start + leg.delay, end + leg.delay)));
  };
  if (!arrives_alone(way, start, end) || !std::all_of(way.begin(), way.end(), is_known_there))
    return medium_.transmit_on_both(sender, transmission, start, end);
  for (const medium::Leg& leg : way) {
    const std::size_t node = index_of(leg.receiver);
    receive_known(node, received_during(seats_[node].clock.last_span()));
  }
  medium_.delivered_on_both(sender, start, end);
}

void EnginePort::transmit_on_both(const bus::ports::Transmission& transmission) {
  const timebase::Oscillator& oscillator = engine_.oscillator(node_);
  engine_.transmit_on_both(node_, transmission, oscillator.time_of(transmission.start),
                           oscillator.time_of(transmission.end));
}

void EnginePort::transmit(const bus::ports::Transmission& transmission) {
  const timebase::Oscillator& oscillator = engine_.oscillator(node_);
  engine_.medium().transmit(node_, transmission, oscillator.time_of(transmission.start),
                            oscillator.time_of(transmission.end));
}

bool EnginePort::wants_bytes(schedules::model::Channel channel) const {
  return engine_.medium().wants_bytes(node_, channel);
}

bool EnginePort::carrier(schedules::model::Channel channel) const {
  return engine_.medium().carrier(node_, channel, engine_.now());
}

}  // namespace ttf::sim::engine
