#include "sim/crank/crank.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::sim::crank {
namespace {

constexpr Microticks kUnknown{std::numeric_limits<std::int64_t>::min()};

}  // namespace

Crank::Crank(const schedules::model::Cluster& cluster, std::size_t others)
    : cluster_(cluster), queue_(medium::FlexRayMedium::kMostPending + others),
      pool_(medium::FlexRayMedium::kMostPending + others), medium_(cluster, queue_, pool_) {
  seats_.reserve(cluster.nodes.size());
  next_.reserve(cluster.nodes.size());
}

void Crank::seat(const timebase::Oscillator& oscillator, std::optional<TrueTime> power_on) {
  TTF_CHECK(seats_.size() < cluster_.nodes.size(), "{} nodes are all", seats_.size());
  TTF_CHECK(!power_on || *power_on >= TrueTime{}, "power-on at {} ns", power_on->ns);
  seats_.push_back(
      {oscillator, !power_on, TrueTime{} - Duration{1}, kUnknown, kNever<TrueTime>, kNever<TrueTime>, {}, {}});
  next_.push_back(kNever<TrueTime>);
  if (power_on) set_next(seats_.size() - 1, *power_on);
}

void Crank::seat_guardian(schedules::model::Channel channel, const timebase::Oscillator& oscillator) {
  TTF_CHECK(cluster_.guardian && cluster_.topology == schedules::model::Topology::kStar, "a guardian for {}",
            cluster_.name);
  auto& coupler = couplers_[index_of(channel)];
  coupler = std::make_unique<medium::StarCoupler>(cluster_, channel, oscillator);
  medium_.set_coupler(channel, coupler.get());
}

void Crank::set_disturbance(medium::Disturbance* disturbance) {
  disturbance_ = disturbance;
  medium_.set_disturbance(disturbance);
}

void Crank::power_off(NodeId node) {
  const std::size_t n = index_of(node);
  set_next(n, kNever<TrueTime>);
  seats_[n].next = kUnknown;
  if (!seats_[n].powered) return;
  seats_[n].powered = false;
  seats_[n].since = now_;
  stop(n);
  medium_.power_off(node, now_);
}

void Crank::power_on(NodeId node, TrueTime at) {
  TTF_CHECK(at >= now_, "power-on at {} ns, it is {} ns", at.ns, now_.ns);
  power_off(node);
  const std::size_t n = index_of(node);
  set_next(n, std::max(at, seats_[n].since + Duration{1}));
}

void Crank::change_drift(NodeId node, std::int64_t ppb) {
  const std::size_t n = index_of(node);
  seats_[n].oscillator.change_drift(now_, ppb);
  seats_[n].next = kUnknown;
  seats_[n].ended = kNever<TrueTime>;
  if (!seats_[n].powered) return;
  drifts(n);
  refresh(n);
}

void Crank::emit(const medium::Leaving& signal, std::optional<NodeId> source) { medium_.emit(signal, source); }

void Crank::refresh(std::size_t node) {
  Seat& seat = seats_[node];
  if (!seat.powered) return;
  const Microticks next = next_event(node);
  // What most arrivals change nothing about.
  if (next == seat.next) return;
  seat.next = next;
  set_next(node, next_time(seat));
}

TrueTime Crank::next_time(const Seat& seat) const {
  return seat.next == kNever<Microticks> ? kNever<TrueTime> : std::max(now_, seat.oscillator.time_of(seat.next));
}

// Keeps `earliest_` the first of those that are due first.
void Crank::set_next(std::size_t node, TrueTime time) {
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

void Crank::run_until(TrueTime end) {
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
        arrive(event, end);
      else
        happen(event);
    }
  }
  now_ = std::max(now_, end);
}

// Everything that the node has to do before anything else happens: often frame after frame.
void Crank::step(std::size_t node) {
  Seat& seat = seats_[node];
  Microticks at = seat.oscillator.ticks_at(now_);
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
    if (!comes_next({next, medium::Phase::kNode, static_cast<std::uint8_t>(node), 0, 0}, until_))
      return set_next(node, next);
    at = next > now_ ? seat.next : seat.oscillator.ticks_at(next);
    now_ = next;
  }
}

// Goes along with a signal from receiver to receiver, as long as nothing else comes between.
void Crank::arrive(medium::MediumEvent event, TrueTime end) {
  while (true) {
    if (medium_.passes_on_both(event) && comes_next(medium_.last_arrival(event), end)) {
      if (!pass_on_both(event, end)) return;
      continue;
    }
    const auto [arrival, goes_on] = medium_.stop_over(event, now_);
    if (arrival) {
      if (seats_[event.node].powered) deliver(event.node, *arrival);
      medium_.release(*arrival);
    }
    if (!goes_on) return;
    const medium::EventOrder next = medium_.next_arrival(event);
    if (!comes_next(next, end)) return queue_.go_on(next, event);
    now_ = next.time;
  }
}

// What comes before everything else until its last stop on both channels, as nearly everything does, makes its stops on
// both at once. True: a node has something to do before that now, and `event` is the next stop, which is due.
bool Crank::pass_on_both(medium::MediumEvent& event, TrueTime end) {
  while (true) {
    const medium::FlexRayMedium::Passage passage = medium_.pass_on_both(event);
    now_ = passage.on_a.end;
    const std::size_t node = index_of(passage.receiver);
    const TrueTime earliest = next_[earliest_];
    if (seats_[node].powered) deliver_on_both(node, passage.on_a);
    medium_.release_on_both(passage.on_a);
    if (!passage.goes_on) return false;
    if (next_[earliest_] == earliest) continue;
    const medium::EventOrder next = medium_.next_arrival(event);
    if (comes_next(next, end)) {
      now_ = next.time;
      return true;
    }
    queue_.go_on(next, event);
    return false;
  }
}

bus::ports::Reception Crank::reception_of(Seat& seat, const medium::FlexRayMedium::Arrival& arrival) {
  if (arrival.start != seat.started || arrival.end != seat.ended) {
    seat.started = arrival.start;
    seat.ended = arrival.end;
    seat.start = seat.oscillator.ticks_at(arrival.start);
    seat.end = seat.oscillator.ticks_at(arrival.end);
  }
  const bool is_frame = arrival.signal == bus::ports::Signal::kFrame;
  bus::ports::Reception reception{arrival.channel, arrival.signal, seat.start, seat.end,
                                  is_frame ? medium_.frame(arrival) : bus::wire::DecodedFrame{}};
  if (arrival.start < seat.since) {
    reception.signal = bus::ports::Signal::kUndecodable;
    reception.start = seat.oscillator.ticks_at(seat.since);
    reception.frame = {};
  }
  return reception;
}

void Crank::deliver(std::size_t node, const medium::FlexRayMedium::Arrival& arrival) {
  Seat& seat = seats_[node];
  receive(node, reception_of(seat, arrival));
  if (next_event(node) != seat.next) refresh(node);
}

void Crank::deliver_on_both(std::size_t node, const medium::FlexRayMedium::Arrival& arrival) {
  if (receive_on_both(node, reception_of(seats_[node], arrival))) refresh(node);
}

void Crank::transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                             TrueTime end) {
  bus::ports::Reception reception{transmission.channel, transmission.signal, {}, {}, transmission.content};
  if (!is_known(sender, reception, start, end)) return medium_.transmit_on_both(sender, transmission, start, end);
  for (const medium::FlexRayMedium::Leg& leg : medium_.way_from(sender)) {
    const std::size_t node = index_of(leg.receiver);
    reception.start = seats_[node].start;
    reception.end = seats_[node].end;
    hear_known(node, reception);
  }
  medium_.told_on_both(sender, start, end);
}

// Whether it tells nobody anything new; so nothing has to arrive. It leaves now, and until it is there nobody sends and
// nothing else happens to those who hear it, but for tasks and CANs.
bool Crank::is_known(NodeId sender, bus::ports::Reception& reception, TrueTime start, TrueTime end) {
  if (start != now_ || !medium_.is_clear()) return false;
  const std::span<const medium::FlexRayMedium::Leg> way = medium_.way_from(sender);
  if (way.empty() || end + way.back().delay > until_) return false;  // the last leg is the longest
  for (const medium::FlexRayMedium::Leg& leg : way) {
    const std::size_t node = index_of(leg.receiver);
    Seat& seat = seats_[node];
    if (!seat.powered) return false;
    reception.start = seat.start = seat.oscillator.ticks_at(start + leg.delay);
    reception.end = seat.end = seat.oscillator.ticks_at(end + leg.delay);
    seat.started = start + leg.delay;
    seat.ended = end + leg.delay;
    if (!knows(node, reception)) return false;
  }
  return true;
}

void CrankPort::transmit_on_both(const bus::ports::Transmission& transmission) {
  const timebase::Oscillator& oscillator = crank_.oscillator(node_);
  crank_.transmit_on_both(node_, transmission, oscillator.time_of(transmission.start),
                          oscillator.time_of(transmission.end));
}

void CrankPort::transmit(const bus::ports::Transmission& transmission) {
  const timebase::Oscillator& oscillator = crank_.oscillator(node_);
  crank_.medium().transmit(node_, transmission, oscillator.time_of(transmission.start),
                           oscillator.time_of(transmission.end));
}

bool CrankPort::wants_bytes(schedules::model::Channel channel) const {
  return crank_.medium().wants_bytes(node_, channel);
}

bool CrankPort::carrier(schedules::model::Channel channel) const {
  return crank_.medium().carrier(node_, channel, crank_.now());
}

}  // namespace ttf::sim::crank
