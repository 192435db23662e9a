#include "sim/flexray_medium.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"

namespace ttf::sim {
namespace {

using bus::Signal;
using schedules::Channel;

// More than can ever be on its way to a node at once, were all others to babble.
constexpr std::size_t kLaneRoom = 64;

bool overlap(const FlexRayMedium::Arrival& a, const FlexRayMedium::Arrival& b) {
  return a.start < b.end && b.start < a.end;
}

}  // namespace

FlexRayMedium::FlexRayMedium(const schedules::Cluster& cluster, MediumQueue& queue, FramePool& pool)
    : queue_(queue),
      pool_(pool),
      position_(cluster.nodes.size(), -1),
      lanes_(2 * cluster.nodes.size()),
      sent_until_(2 * cluster.nodes.size()),
      min_delay_ps_(cluster.flexray.gdMinPropagationDelay_ps),
      max_delay_ps_(cluster.flexray.gdMaxPropagationDelay_ps) {
  int on_bus = 0;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (!cluster.nodes[n].flexray) continue;
    position_[n] = on_bus++;
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (includes(cluster.nodes[n].flexray->pChannels, channel))
        attached_[index_of(channel)].push_back(static_cast<NodeId>(n));
  }
  ends_ = on_bus - 1;
  for (Lane& lane : lanes_) lane.reserve(kLaneRoom);
}

Duration FlexRayMedium::delay(NodeId from, NodeId to) const {
  if (ends_ <= 0) return {};
  const int hops = std::abs(position_[index_of(from)] - position_[index_of(to)]);
  const std::int64_t ps = min_delay_ps_ + (max_delay_ps_ - min_delay_ps_) * hops / ends_;
  return {(ps + 999) / 1000};
}

void FlexRayMedium::transmit(NodeId sender, const bus::Transmission& transmission, TrueTime start, TrueTime end) {
  Leaving signal{sender, transmission.channel, transmission.signal, start, end, transmission.bytes};
  if (disturbance_ != nullptr && !disturbance_->leaving(signal)) return;
  busy_[index_of(signal.channel)] += signal.end - signal.start;
  sent_until_[lane_of(sender, signal.channel)] = signal.end;
  spread(signal, sender);
}

void FlexRayMedium::emit(const Leaving& signal, std::optional<NodeId> source) { spread(signal, source); }

void FlexRayMedium::spread(const Leaving& signal, std::optional<NodeId> sender) {
  const auto& attached = attached_[index_of(signal.channel)];
  const auto receivers = static_cast<int>(std::count_if(attached.begin(), attached.end(),
                                                        [&](NodeId node) { return node != sender; }));
  if (receivers == 0) return;
  Arrival arrival;
  if (signal.signal == Signal::kFrame) arrival.frame = pool_.put_frame(signal.channel, signal.bytes, receivers);
  for (const NodeId node : attached) {
    if (node == sender) continue;
    const Duration on_the_way = sender ? delay(*sender, node) : Duration{};
    Arriving last{signal.sender, node, signal.channel, signal.signal, signal.start + on_the_way,
                  signal.end + on_the_way};
    const bool arrives = disturbance_ == nullptr || disturbance_->arriving(last);
    arrival.channel = signal.channel;
    arrival.signal = last.signal;
    arrival.start = last.start;
    arrival.end = last.end;
    if (signal.signal == Signal::kFrame && (!arrives || last.signal != Signal::kFrame)) pool_.release(arrival.frame);
    if (arrives) put(node, signal.sender, arrival);
  }
}

void FlexRayMedium::put(NodeId receiver, NodeId sender, const Arrival& arrival) {
  Lane& pending = lane(receiver, arrival.channel);
  Pending made{next_id_++, arrival, sender, false};
  for (std::size_t i = 0; i < pending.size();) {
    if (!overlap(pending[i].arrival, made.arrival)) {
      ++i;
      continue;
    }
    // Two become one.
    const Arrival other = pending[i].arrival;
    const bool cas = other.signal == Signal::kCas && made.arrival.signal == Signal::kCas;
    release(other);
    release(made.arrival);
    made.arrival.signal = cas ? Signal::kCas : Signal::kUndecodable;
    made.arrival.start = std::min(made.arrival.start, other.start);
    made.arrival.end = std::max(made.arrival.end, other.end);
    made.merged = true;
    take_out(pending, i);
    i = 0;   // grown, it may reach what it did not reach before
  }
  TTF_CHECK(pending.size() < kLaneRoom, "{} signals on their way to one node", pending.size());
  pending.push_back(made);
  MediumEvent event;
  event.kind = MediumEvent::Kind::kFlexRayArrival;
  event.node = static_cast<std::uint8_t>(receiver);
  event.channel_or_bus = static_cast<std::uint8_t>(arrival.channel);
  event.frame = made.id;
  const auto rank = static_cast<std::uint16_t>((index_of(arrival.channel) << 8) | index_of(sender));
  queue_.schedule(made.arrival.end, Phase::kArrival, event.node, event, rank);
}

std::optional<FlexRayMedium::Arrival> FlexRayMedium::arrive(const MediumEvent& event, TrueTime now) {
  Lane& pending = lane(static_cast<NodeId>(event.node), static_cast<Channel>(event.channel_or_bus));
  const auto found =
      std::find_if(pending.begin(), pending.end(), [&](const Pending& one) { return one.id == event.frame; });
  if (found == pending.end()) return std::nullopt;
  const Arrival arrival = found->arrival;
  TTF_CHECK(arrival.end == now, "an arrival of {} ns at {} ns", arrival.end.ns, now.ns);
  take_out(pending, static_cast<std::size_t>(found - pending.begin()));
  return arrival;
}

// The event of what is taken out finds nothing any more.
void FlexRayMedium::take_out(Lane& pending, std::size_t index) {
  pending[index] = pending.back();
  pending.pop_back();
}

void FlexRayMedium::power_off(NodeId node, TrueTime now) {
  if (position_[index_of(node)] < 0) return;
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    Lane& incoming = lane(node, channel);
    for (const Pending& one : incoming) release(one.arrival);
    incoming.clear();
    TrueTime& until = sent_until_[lane_of(node, channel)];
    if (until > now) busy_[index_of(channel)] += now - until;
    until = std::min(until, now);
    for (const NodeId receiver : attached_[index_of(channel)]) {
      Lane& pending = lane(receiver, channel);
      const TrueTime cut = now + delay(node, receiver);
      for (std::size_t i = 0; i < pending.size();) {
        const Pending one = pending[i];
        if (one.sender != node || one.merged || one.arrival.end <= cut) {
          ++i;
          continue;
        }
        release(one.arrival);
        take_out(pending, i);
        if (one.arrival.start >= cut) continue;
        Arrival rest = one.arrival;
        rest.signal = Signal::kUndecodable;
        rest.end = cut;
        put(receiver, node, rest);
      }
    }
  }
}

void FlexRayMedium::release(const Arrival& arrival) {
  if (arrival.signal == Signal::kFrame) pool_.release(arrival.frame);
}

bool FlexRayMedium::carrier(NodeId node, Channel channel, TrueTime now) const {
  const Lane& pending = lanes_[2 * index_of(node) + index_of(channel)];
  return std::any_of(pending.begin(), pending.end(), [&](const Pending& one) { return one.arrival.start <= now; });
}

}  // namespace ttf::sim
