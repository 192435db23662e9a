#include "sim/medium/flexray_medium.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

Arriving on_last_metre(const Leaving& signal, NodeId receiver, Duration delay) {
  Arriving last;
  last.sender = signal.sender;
  last.receiver = receiver;
  last.channel = signal.channel;
  last.signal = signal.signal;
  last.start = signal.start + delay;
  last.end = signal.end + delay;
  last.bytes = signal.bytes;
  last.emitted = signal.emitted;
  return last;
}

}  // namespace

FlexRayMedium::FlexRayMedium(const schedules::model::Cluster& cluster, MediumQueue& queue, FramePool& pool)
    : ways_(cluster), queue_(queue), pool_(pool), flights_(cluster.flexray, ways_, queue, pool, kFlights),
      clear_flights_(ways_, flights_, queue, pool), sent_until_(2 * cluster.nodes.size()),
      spoken_(2 * cluster.nodes.size()) {
  reached_.reserve(cluster.nodes.size());
  approaching_.reserve(kFlights);
}

void FlexRayMedium::set_log(ChannelLog* log) {
  log_ = log;
  flights_.set_log(log);
  clear_flights_.set_log(log);
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
  if (coupler_[index_of(signal.channel)] != nullptr) return to_coupler(signal, start, logged);
  spread(signal, {&ways_.from(sender)}, logged, in_bytes ? nullptr : &transmission.content);
}

void FlexRayMedium::transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                                     TrueTime end) {
  const Ways& ways = ways_.from(sender);
  const int receivers = static_cast<int>(ways[0].size());
  if (!is_clear() || receivers == 0) {
    transmit(sender, transmission, start, end);
    return transmit(sender, bus::ports::on_b(transmission), start, end);
  }
  const std::uint32_t frame = pool_.put_content(transmission.content, 2 * receivers);
  clear_flights_.depart_on_both(sender, {start, end, frame, Channel::kA, Signal::kFrame, ChannelLog::kNone}, ways);
  delivered_on_both(sender, start, end);
}

void FlexRayMedium::delivered_on_both(NodeId sender, TrueTime start, TrueTime end) {
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    busy_[index_of(channel)] += end - start;
    sent_until_[lane_of(sender, channel)] = end;
  }
}

void FlexRayMedium::emit(const Leaving& signal, std::optional<NodeId> source) {
  Leaving made = signal;
  made.emitted = true;
  if (source) made.sender = *source;
  Coupler* coupler = coupler_[index_of(made.channel)];
  const ChannelLog::Id logged = log_ != nullptr ? log_->appears(made) : ChannelLog::kNone;
  if (log_ != nullptr && source) speaks(*source, made);
  if (coupler != nullptr && source) return to_coupler(made, made.start, logged);
  if (coupler != nullptr) coupler->disturbed(made);
  spread(made, {source ? &ways_.from(*source) : &ways_.from_nowhere()}, logged);
}

// Spreads a signal to its receivers: as a clear flight if it is alone and arrives everywhere as it left,
// otherwise as a flight that is noted at each of them.
void FlexRayMedium::spread(const Leaving& signal, const Outset& outset, ChannelLog::Id logged,
                           const bus::wire::DecodedFrame* content) {
  const Way& way = (*outset.ways)[index_of(signal.channel)];
  const auto is_passed_over = [&](const Leg& leg) { return leg.receiver == outset.passed_over; };
  const bool passes_over = outset.at_coupler && std::any_of(way.begin(), way.end(), is_passed_over);
  const int receivers = static_cast<int>(way.size()) - (passes_over ? 1 : 0);
  if (log_ != nullptr) log_->spreads(logged, receivers);
  if (receivers == 0) {
    if (log_ != nullptr) log_->arrived(logged);
    return;
  }
  Arrival left{signal.start, signal.end, 0, signal.channel, signal.signal, logged};
  if (signal.signal == Signal::kFrame)
    left.frame = content != nullptr ? pool_.put_content(*content, receivers)
                                    : pool_.put_frame(signal.channel, signal.bytes, receivers);
  const bool alone = fast_ && is_empty(signal.channel);
  if (!alone) clear_flights_.crowd(signal.channel);
  const bool unchanged = alone && is_undisturbed();
  if (!unchanged) pass_last_metres(signal, outset, left);
  if (unchanged || (alone && is_as_it_left(left, receivers)))
    return clear_flights_.depart(signal.sender, left, *outset.ways, outset.passed_over);
  const FlightNumber flight = flights_.take_off(signal.sender, signal.channel, logged);
  for (const Reached& one : reached_) flights_.put(flight, one.leg.receiver, one.arrival);
  flights_.depart(flight);
}

void FlexRayMedium::pass_last_metres(const Leaving& signal, const Outset& outset, const Arrival& left) {
  reached_.clear();
  for (const Leg& leg : (*outset.ways)[index_of(signal.channel)]) {
    if (leg.receiver == outset.passed_over) continue;
    if (const auto arrival = pass_last_metre(signal, outset, leg, left)) reached_.push_back({leg, *arrival});
  }
}

// Returns nothing if the signal does not arrive.
std::optional<Arrival> FlexRayMedium::pass_last_metre(const Leaving& signal, const Outset& outset, const Leg& leg,
                                                      const Arrival& left) {
  Arriving last = on_last_metre(signal, leg.receiver, leg.delay);
  last.regenerated = outset.at_coupler;
  const bool arrives = disturbance_ == nullptr || disturbance_->arriving(last);
  const bool frame_arrives = arrives && last.signal == Signal::kFrame;
  const bool same_bytes = last.bytes.data() == signal.bytes.data();
  Arrival arrival{last.start, last.end, left.frame, left.channel, last.signal, left.logged};
  if (signal.signal == Signal::kFrame && !(frame_arrives && same_bytes)) pool_.release(left.frame);
  if (frame_arrives && !same_bytes) arrival.frame = pool_.put_frame(signal.channel, last.bytes, 1);
  if (log_ != nullptr) arrival.logged = witness(left.logged, signal, last, arrives);
  if (!arrives) return std::nullopt;
  return arrival;
}

bool FlexRayMedium::is_as_it_left(const Arrival& left, int receivers) const {
  return reached_.size() == static_cast<std::size_t>(receivers) &&
         std::all_of(reached_.begin(), reached_.end(),
                     [&](const Reached& one) { return one.arrival == left.later_by(one.leg.delay); });
}

void FlexRayMedium::to_coupler(const Leaving& signal, TrueTime now, ChannelLog::Id logged) {
  Arriving last = on_last_metre(signal, kNoNode, branch(signal.sender));
  if (disturbance_ != nullptr && !disturbance_->arriving(last)) {
    if (log_ != nullptr) log_->withheld(logged);
    return;
  }
  const Arrival arrival{last.start, last.end, 0, signal.channel, last.signal, logged};
  Approaching made{arrival, flights_.reserve(), signal.sender, signal.emitted};
  if (last.signal == Signal::kFrame) made.arrival.frame = pool_.put_frame(signal.channel, last.bytes, 1);
  approaching_.push_back(made);
  MediumEvent event = event_of(made.number);
  event.at_coupler = true;
  event.node = static_cast<std::uint8_t>(signal.sender);
  event.channel_or_bus = static_cast<std::uint8_t>(signal.channel);
  // Never in the past, even if a disturbance has put it there.
  queue_.schedule(std::max(now, last.start), Phase::kArrival, event.node, event,
                  static_cast<std::uint16_t>(index_of(signal.channel) << 8));
}

void FlexRayMedium::at_coupler(FlightNumber number) {
  const auto found = std::find_if(approaching_.begin(), approaching_.end(),
                                  [&](const Approaching& one) { return one.number == number; });
  TTF_CHECK(found != approaching_.end(), "nothing on its way to the coupler is {}", number);
  const Approaching came = *found;
  *found = approaching_.back();
  approaching_.pop_back();
  flights_.give_back(number);
  const Arrival& arrived = came.arrival;
  const bool is_frame = arrived.signal == Signal::kFrame;
  Leaving signal{came.sender, arrived.channel, arrived.signal, arrived.start, arrived.end, {}, came.emitted};
  if (is_frame) signal.bytes = pool_.bytes(arrived.frame);
  const Leaving as_it_came = signal;
  Coupler& coupler = *coupler_[index_of(arrived.channel)];
  const bool passes = coupler.pass(signal, is_frame ? &pool_.decoded(arrived.frame) : nullptr);
  if (log_ != nullptr && passes) log_->regenerated(arrived.logged, as_it_came, signal, branch(came.sender));
  if (log_ != nullptr && !passes) log_->withheld(arrived.logged);
  if (passes) spread(signal, {&ways_.from_coupler(), true, came.sender}, arrived.logged);
  release(arrived);
}

// Returns a receiver's log id of a signal: kNone if it cannot decode it. A node that sends at the same time cannot.
ChannelLog::Id FlexRayMedium::witness(ChannelLog::Id logged, const Leaving& signal, const Arriving& last,
                                      bool arrives) {
  if (!arrives) {
    log_->not_received(logged);
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
  clear_flights_.crowd(signal.channel);
  spoken_[lane_of(node, signal.channel)] = {signal.start, signal.end};
  flights_.talk_over(node, signal.channel, signal.start, signal.end);
}

std::optional<Arrival> FlexRayMedium::arrive(const MediumEvent& event, TrueTime now) {
  const Stopover here = stop_over(event, now);
  MediumEvent next = event;
  if (here.goes_on) {
    const EventOrder order = next_arrival(next);
    queue_.go_on(order, next);
  }
  return here.arrival;
}

void FlexRayMedium::power_off(NodeId node, TrueTime now) {
  if (!ways_.is_on_bus(node)) return;
  if (log_ != nullptr) log_->breaks_off(node, now);
  for (const Channel channel : {Channel::kA, Channel::kB}) clear_flights_.crowd(channel);
  break_off_to_coupler(node, now);
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    flights_.lose_receiver(node, channel);
    break_off(node, channel, now);
  }
}

// A signal that has not begun at the coupler ends there when the sender's silence arrives.
void FlexRayMedium::break_off_to_coupler(NodeId sender, TrueTime now) {
  if (approaching_.empty()) return;
  const TrueTime silent = now + branch(sender);
  for (Approaching& one : approaching_) {
    if (one.sender != sender || one.arrival.end <= silent) continue;
    release(one.arrival);
    one.arrival.signal = Signal::kUndecodable;
    one.arrival.end = std::max(silent, one.arrival.start + Duration{1});
  }
}

void FlexRayMedium::break_off(NodeId sender, Channel channel, TrueTime now) {
  const auto c = index_of(channel);
  TrueTime& until = sent_until_[lane_of(sender, channel)];
  if (until > now) busy_[c] += now - until;
  until = std::min(until, now);
  if (coupler_[c] == nullptr) return flights_.break_off(sender, channel, ways_.from(sender)[c], now, now);
  // If the coupler holds the signal, the sender's part of it ends before the forwarded signal.
  const TrueTime silent = now + branch(sender);
  const TrueTime ends = coupler_[c]->fell_silent(sender, silent);
  flights_.break_off(sender, channel, ways_.from_coupler()[c], silent, ends);
}

bool FlexRayMedium::carrier(NodeId node, Channel channel, TrueTime now) const {
  return clear_flights_.any(channel) ? clear_flights_.carrier(node, channel, now)
                                     : flights_.carrier(node, channel, now);
}

}  // namespace ttf::sim::medium
