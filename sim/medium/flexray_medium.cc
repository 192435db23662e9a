#include "sim/medium/flexray_medium.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

}  // namespace

FlexRayMedium::FlexRayMedium(const schedules::model::Cluster& cluster, MediumQueue& queue, FramePool& pool)
    : queue_(queue), pool_(pool), position_(cluster.nodes.size(), -1), lanes_(2 * cluster.nodes.size()),
      ways_(cluster.nodes.size()), sent_until_(2 * cluster.nodes.size()), spoken_(2 * cluster.nodes.size()),
      min_delay_ps_(cluster.flexray.gdMinPropagationDelay_ps), max_delay_ps_(cluster.flexray.gdMaxPropagationDelay_ps),
      star_(cluster.topology == schedules::model::Topology::kStar) {
  int on_bus = 0;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (!cluster.nodes[n].flexray) continue;
    position_[n] = on_bus++;
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (includes(cluster.nodes[n].flexray->pChannels, channel))
        attached_[index_of(channel)].push_back(static_cast<NodeId>(n));
  }
  ends_ = on_bus - 1;
  to_coupler_.reserve(kFlights);
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    from_nowhere_[index_of(channel)] = make_way(channel, std::nullopt, false);
    if (star_) from_coupler_[index_of(channel)] = make_way(channel, std::nullopt, true);
  }
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (position_[n] >= 0) ways_[n][index_of(channel)] = make_way(channel, static_cast<NodeId>(n), false);
  same_receivers_ = attached_[0] == attached_[1];
  most_stops_ = static_cast<std::size_t>(on_bus);
  add_flights(kFlights);
}

FlexRayMedium::Way FlexRayMedium::make_way(Channel channel, std::optional<NodeId> sender, bool from_coupler) const {
  Way way;
  for (const NodeId node : attached_[index_of(channel)])
    if (node != sender) way.push_back({node, from_coupler ? branch(node) : sender ? delay(*sender, node) : Duration{}});
  std::stable_sort(way.begin(), way.end(), [](const Leg& a, const Leg& b) { return a.delay < b.delay; });
  return way;
}

std::int64_t FlexRayMedium::branch_ps(NodeId node) const {
  const int steps = ends_ - 1;  // to the two longest
  const std::int64_t range = max_delay_ps_ - min_delay_ps_;
  const std::int64_t longer = steps <= 0 ? range : range * std::min(position_[index_of(node)], steps) / steps;
  return (min_delay_ps_ + longer) / 2;
}

Duration FlexRayMedium::branch(NodeId node) const { return {(branch_ps(node) + 999) / 1000}; }

Duration FlexRayMedium::delay(NodeId from, NodeId to) const {
  if (ends_ <= 0) return {};
  if (star_) return {(branch_ps(from) + branch_ps(to) + 999) / 1000};
  const int hops = std::abs(position_[index_of(from)] - position_[index_of(to)]);
  const std::int64_t ps = min_delay_ps_ + (max_delay_ps_ - min_delay_ps_) * hops / ends_;
  return {(ps + 999) / 1000};
}

void FlexRayMedium::transmit(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                             TrueTime end) {
  Leaving signal{sender, transmission.channel, transmission.signal, start, end, {}};
  const bool in_bytes = carries_bytes(sender, transmission.channel);
  if (in_bytes) signal.bytes = transmission.bytes;
  const ChannelLog::Id logged = log_ != nullptr ? log_->sent(sender, transmission, start, end) : ChannelLog::kNone;
  if (disturbance_ != nullptr) {
    const bool leaves = disturbance_->leaving(signal);
    if (log_ != nullptr) leaves ? log_->leaves(logged, signal) : log_->withheld(logged);
    if (!leaves) return;
  }
  if (log_ != nullptr) speaks(sender, signal);
  busy_[index_of(signal.channel)] += signal.end - signal.start;
  sent_until_[lane_of(sender, signal.channel)] = signal.end;
  if (coupler_[index_of(signal.channel)] != nullptr) return to_coupler(signal, sender, start, logged);
  spread(signal, sender, false, logged, in_bytes ? nullptr : &transmission.content);
}

void FlexRayMedium::emit(const Leaving& signal, std::optional<NodeId> source) {
  Leaving made = signal;
  made.emitted = true;
  Coupler* coupler = coupler_[index_of(made.channel)];
  const ChannelLog::Id logged = log_ != nullptr ? log_->appears(made) : ChannelLog::kNone;
  if (log_ != nullptr && source) speaks(*source, made);
  if (coupler == nullptr) return spread(made, source, false, logged);
  if (source) return to_coupler(made, *source, made.start, logged);
  coupler->disturbed(made);
  spread(made, source, false, logged);
}

void FlexRayMedium::spread(const Leaving& signal, std::optional<NodeId> sender, bool regenerated, ChannelLog::Id logged,
                           const bus::wire::DecodedFrame* content) {
  const auto c = index_of(signal.channel);
  const Ways& ways = regenerated ? from_coupler_ : sender ? ways_[index_of(*sender)] : from_nowhere_;
  const Way& way = ways[c];
  const bool itself =
      regenerated && std::any_of(way.begin(), way.end(), [&](const Leg& leg) { return leg.receiver == sender; });
  const int receivers = static_cast<int>(way.size()) - (itself ? 1 : 0);
  if (log_ != nullptr) log_->spreads(logged, receivers);
  if (receivers == 0) {
    if (log_ != nullptr) log_->arrived(logged);
    return;
  }
  std::uint32_t frame = 0;
  if (signal.signal == Signal::kFrame)
    frame = content != nullptr ? pool_.put_content(*content, receivers)
                               : pool_.put_frame(signal.channel, signal.bytes, receivers);
  const NodeId passed_over = itself ? *sender : kNoNode;
  const Arrival left{signal.start, signal.end, frame, signal.channel, signal.signal, logged};
  // It is clear until something is changed on its last metre, or one of its receivers sends at the same time.
  Flight* flight = nullptr;
  if (aloft_[c] > 0) {
    crowd(signal.channel);
    flight = &take_off(signal.sender, signal.channel, logged);
  } else if (disturbance_ == nullptr && log_ == nullptr) {
    return depart_clear(signal.sender, left, ways, passed_over);
  }
  for (const Leg& leg : way) {
    if (leg.receiver == sender) continue;
    Arriving last{signal.sender,          leg.receiver, signal.channel, signal.signal, signal.start + leg.delay,
                  signal.end + leg.delay, regenerated,  signal.bytes,   signal.emitted};
    const bool arrives = disturbance_ == nullptr || disturbance_->arriving(last);
    const bool same_bytes = last.bytes.data() == signal.bytes.data();
    if (flight == nullptr) {
      if (arrives && same_bytes && last.signal == signal.signal && last.start == signal.start + leg.delay &&
          last.end == signal.end + leg.delay && !(log_ != nullptr && talks_over(last, signal.channel)))
        continue;
      flight = &take_off(signal.sender, signal.channel, logged);
      lay_out(*flight, std::span(way.data(), &leg), passed_over, left);
    }
    Arrival arrival{last.start, last.end, frame, signal.channel, last.signal, ChannelLog::kNone};
    const bool as_it_left = arrives && last.signal == Signal::kFrame && same_bytes;
    if (signal.signal == Signal::kFrame && !as_it_left) pool_.release(frame);
    if (arrives && last.signal == Signal::kFrame && !as_it_left)
      arrival.frame = pool_.put_frame(signal.channel, last.bytes, 1);
    if (log_ != nullptr) arrival.logged = witness(logged, signal, last, arrives);
    if (arrives) put(*flight, leg.receiver, arrival);
  }
  if (flight == nullptr) return depart_clear(signal.sender, left, ways, passed_over);
  depart(*flight);
}

void FlexRayMedium::to_coupler(const Leaving& signal, NodeId sender, TrueTime now, ChannelLog::Id logged) {
  const Duration on_the_way = branch(sender);
  Arriving last{sender, kNoNode,      signal.channel, signal.signal, signal.start + on_the_way, signal.end + on_the_way,
                false,  signal.bytes, signal.emitted};
  if (disturbance_ != nullptr && !disturbance_->arriving(last)) {
    if (log_ != nullptr) log_->withheld(logged);
    return;
  }
  const Arrival arrival{last.start, last.end, 0, signal.channel, last.signal, logged};
  Pending made{arrival, next_id_++, sender, false, signal.emitted};
  if (last.signal == Signal::kFrame) made.arrival.frame = pool_.put_frame(signal.channel, last.bytes, 1);
  to_coupler_.push_back(made);
  MediumEvent event;
  event.kind = MediumEvent::Kind::kFlexRayArrival;
  event.at_coupler = true;
  event.node = static_cast<std::uint8_t>(sender);
  event.channel_or_bus = static_cast<std::uint8_t>(signal.channel);
  event.frame = made.id;
  // Not in the past, wherever a disturbance has put it.
  queue_.schedule(std::max(now, last.start), Phase::kArrival, event.node, event,
                  static_cast<std::uint16_t>(index_of(signal.channel) << 8));
}

void FlexRayMedium::at_coupler(const MediumEvent& event) {
  const auto found =
      std::find_if(to_coupler_.begin(), to_coupler_.end(), [&](const Pending& one) { return one.id == event.frame; });
  TTF_CHECK(found != to_coupler_.end(), "nothing on its way to the coupler is {}", event.frame);
  const auto [arrived, id, sender, merged, emitted] = *found;
  *found = to_coupler_.back();
  to_coupler_.pop_back();
  const bool is_frame = arrived.signal == Signal::kFrame;
  Leaving signal{sender, arrived.channel, arrived.signal, arrived.start, arrived.end, {}, emitted};
  if (is_frame) signal.bytes = pool_.bytes(arrived.frame);
  const Leaving as_it_came = signal;
  const bool passes =
      coupler_[index_of(arrived.channel)]->pass(signal, is_frame ? &pool_.decoded(arrived.frame) : nullptr);
  if (log_ != nullptr)
    passes ? log_->regenerated(arrived.logged, as_it_came, signal, branch(sender)) : log_->withheld(arrived.logged);
  if (passes) spread(signal, sender, true, arrived.logged);
  release(arrived);
}

// What a receiver makes of a signal's arrival: kNone if it will not make it out. Who sends at the same time does not.
ChannelLog::Id FlexRayMedium::witness(ChannelLog::Id logged, const Leaving& signal, const Arriving& last,
                                      bool arrives) {
  if (!arrives) {
    log_->unheard(logged);
    return ChannelLog::kNone;
  }
  if (last.signal != signal.signal || talks_over(last, signal.channel)) {
    log_->lost(logged);
    return ChannelLog::kNone;
  }
  if (last.signal == Signal::kFrame && last.bytes.data() != signal.bytes.data()) log_->changed(logged, last.bytes);
  return logged;
}

void FlexRayMedium::speaks(NodeId node, const Leaving& signal) {
  crowd(signal.channel);
  spoken_[lane_of(node, signal.channel)] = {signal.start, signal.end};
  for (Pending& one : lane(node, signal.channel)) {
    if (one.arrival.end <= signal.start || signal.end <= one.arrival.start) continue;
    log_->lost(one.arrival.logged);
    one.arrival.logged = ChannelLog::kNone;
  }
}

std::optional<FlexRayMedium::Arrival> FlexRayMedium::arrive(const MediumEvent& event, TrueTime now) {
  const Stopover here = stop_over(event, now);
  MediumEvent next = event;
  if (here.goes_on) queue_.go_on(next_arrival(next), next);
  return here.arrival;
}

FlexRayMedium::Stopover FlexRayMedium::stop_over_noted(const MediumEvent& event, TrueTime now) {
  if (event.at_coupler) {
    at_coupler(event);
    return {};
  }
  Flight& flight = flights_[event.frame];
  const Stop stop = stops_of(flight)[flight.next++];
  Stopover here;
  here.goes_on = flight.next < flight.size;
  if (!here.goes_on) land(flight);
  Lane& pending = lane(stop.receiver, flight.channel);
  const auto found =
      std::find_if(pending.begin(), pending.end(), [&](const Pending& one) { return one.id == stop.id; });
  if (found == pending.end()) return here;
  here.arrival = found->arrival;
  TTF_CHECK(here.arrival->end == now, "an arrival of {} ns at {} ns", here.arrival->end.ns, now.ns);
  pending.take_out(static_cast<std::size_t>(found - pending.begin()));
  return here;
}

void FlexRayMedium::power_off(NodeId node, TrueTime now) {
  if (position_[index_of(node)] < 0) return;
  if (log_ != nullptr) log_->breaks_off(node, now);
  for (const Channel channel : {Channel::kA, Channel::kB}) crowd(channel);
  for (Pending& one : to_coupler_) {
    const TrueTime cut = now + branch(node);
    if (one.sender != node || one.arrival.end <= cut) continue;
    release(one.arrival);
    one.arrival.signal = Signal::kUndecodable;
    one.arrival.end = std::max(cut, one.arrival.start + Duration{1});
  }
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    Coupler* coupler = coupler_[index_of(channel)];
    // When the sender's part of what is spread ends, and when that itself does.
    const TrueTime silent = coupler != nullptr ? now + branch(node) : now;
    const TrueTime ends = coupler != nullptr ? coupler->fell_silent(node, silent) : now;
    Lane& incoming = lane(node, channel);
    for (const Pending& one : incoming) release(one.arrival);
    incoming.clear();
    Flight* left = nullptr;  // what is left of it
    TrueTime& until = sent_until_[lane_of(node, channel)];
    if (until > now) busy_[index_of(channel)] += now - until;
    until = std::min(until, now);
    for (const NodeId receiver : attached_[index_of(channel)]) {
      Lane& pending = lane(receiver, channel);
      const Duration on_the_way = coupler != nullptr ? branch(receiver) : delay(node, receiver);
      for (std::size_t i = 0; i < pending.size();) {
        const Pending one = pending[i];
        // The rest of one comes by here, too.
        const bool is_rest = one.arrival.signal == Signal::kUndecodable && one.arrival.end == ends + on_the_way;
        if (one.sender != node || one.merged || is_rest || one.arrival.end <= silent + on_the_way) {
          ++i;
          continue;
        }
        release(one.arrival);
        pending.take_out(i);
        if (one.arrival.start >= ends + on_the_way) continue;
        Arrival rest = one.arrival;
        rest.signal = Signal::kUndecodable;
        rest.end = ends + on_the_way;
        rest.logged = ChannelLog::kNone;
        if (left == nullptr) left = &take_off(node, channel, ChannelLog::kNone);
        put(*left, receiver, rest);
      }
    }
    if (left != nullptr) depart(*left);
  }
}

bool FlexRayMedium::carrier(NodeId node, Channel channel, TrueTime now) const {
  if (const Flight* clear = clear_[index_of(channel)]) return carrier_of_clear(*clear, node, channel, now);
  const Lane& pending = lanes_[2 * index_of(node) + index_of(channel)];
  return std::any_of(pending.begin(), pending.end(), [&](const Pending& one) { return one.arrival.start <= now; });
}

}  // namespace ttf::sim::medium
