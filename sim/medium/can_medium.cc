#include "sim/medium/can_medium.h"

#include <algorithm>
#include <cmath>

#include "bus/wire/can_timing.h"
#include "core/check.h"
#include "core/random.h"
#include "schedules/analysis/can_load.h"

namespace ttf::sim::medium {

CanMedium::CanMedium(const schedules::model::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes,
                     MediumQueue& queue, FramePool& pool, recording::records::Sink& sink, std::uint64_t seed,
                     std::uint32_t replication)
    : cluster_(cluster), bus_(bus), nodes_(nodes.begin(), nodes.end()), queue_(queue), pool_(pool), sink_(sink) {
  pending_.reserve(1024);
  const schedules::model::CanBus& can = cluster.can_buses[bus];
  if (can.other_load <= 0.0) return;
  other_length_ = schedules::analysis::can_worst_case(can, can.flexible_data_rate ? 64 : 8);
  constexpr double kSeldom_ns = 1e15;  // eleven days
  const double period = std::ceil(static_cast<double>(other_length_.ns) / can.other_load);
  other_period_ = {static_cast<std::int64_t>(std::min(period, kSeldom_ns))};
  RandomStream phase({seed, replication, Purpose::kOtherTraffic, static_cast<std::uint16_t>(bus), 0});
  next_other_ = TrueTime{} + Duration{phase.integer(0, other_period_.ns - 1)};
}

// Counts other traffic up to now while no frame here waited, with its frame that is on the bus.
void CanMedium::pass_others(TrueTime now) {
  if (other_length_ == Duration{}) return;
  while (next_other_ <= now && idle_from_ <= now) {
    idle_from_ = std::max(next_other_, idle_from_) + other_length_;
    busy_ += other_length_;
    next_other_ += other_period_;
  }
}

void CanMedium::arbitrate_at(TrueTime when) {
  arbitration_due_ = true;
  MediumEvent event;
  event.kind = MediumEvent::Kind::kCanArbitration;
  event.node = event.channel_or_bus = static_cast<std::uint8_t>(bus_);
  queue_.schedule(when, Phase::kArbitration, event.node, event);
}

void CanMedium::send(NodeId sender, TrueTime now, const bus::ports::CanFrame& frame) {
  TTF_CHECK(pending_.size() < pending_.capacity(), "{} frames wait on {}", pending_.size(),
            cluster_.can_buses[bus_].name);
  const int receivers = static_cast<int>(nodes_.size()) - 1;
  // One use more than there are receivers: the medium keeps the frame until it has been sent.
  pending_.push_back(
      {sender, next_order_++, frame.identifier, frame.flexible_data_rate, pool_.put(frame.data, receivers + 1)});
  if (arbitration_due_) return;
  pass_others(now);
  arbitrate_at(std::max(now, idle_from_));
}

void CanMedium::arbitrate(TrueTime now) {
  arbitration_due_ = false;
  if (pending_.empty()) return;
  pass_others(now);
  if (idle_from_ > now) return arbitrate_at(idle_from_);
  // A node offers its oldest frame of an identifier first; across nodes the lowest identifier wins.
  const auto winner = std::min_element(pending_.begin(), pending_.end(), [](const Pending& a, const Pending& b) {
    if (a.identifier != b.identifier) return a.identifier < b.identifier;
    if (a.sender != b.sender) return a.sender < b.sender;
    return a.order < b.order;
  });
  const Pending frame = *winner;
  pending_.erase(winner);
  const bus::wire::CanFrameTimes times =
      bus::wire::can_frame_times(cluster_.can_buses[bus_], frame.identifier, pool_.bytes(frame.frame));
  const TrueTime accepted = now + times.accepted;
  busy_ += times.idle;
  idle_from_ = now + times.idle;
  for (const NodeId node : nodes_) {
    if (node == frame.sender) continue;
    MediumEvent event;
    event.kind = MediumEvent::Kind::kCanArrival;
    event.node = static_cast<std::uint8_t>(node);
    event.channel_or_bus = static_cast<std::uint8_t>(bus_);
    event.flexible_data_rate = frame.flexible_data_rate;
    event.identifier = frame.identifier;
    event.frame = frame.frame;
    event.sender = static_cast<std::uint8_t>(frame.sender);
    event.start = now;
    queue_.schedule(accepted, Phase::kArrival, event.node, event);
  }
  report(frame, now, accepted);
  pool_.release(frame.frame);
  if (!pending_.empty()) arbitrate_at(idle_from_);
}

void CanMedium::power_off(NodeId node) {
  std::erase_if(pending_, [&](const Pending& frame) {
    if (frame.sender != node) return false;
    for (std::size_t use = 0; use < nodes_.size(); ++use) pool_.release(frame.frame);
    return true;
  });
}

void CanMedium::report(const Pending& frame, TrueTime start, TrueTime end) {
  recording::records::CanFrameSent sent;
  sent.bus = static_cast<std::uint8_t>(bus_);
  sent.start.true_time = start;
  sent.end.true_time = end;
  sent.start.node = sent.end.node = frame.sender;
  sent.identifier = frame.identifier;
  sent.flexible_data_rate = frame.flexible_data_rate;
  sent.data = pool_.bytes(frame.frame);
  sink_.on(sent);
}

}  // namespace ttf::sim::medium
