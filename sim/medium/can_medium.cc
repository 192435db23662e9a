#include "sim/medium/can_medium.h"

#include <algorithm>
#include <cmath>

#include "bus/wire/can_timing.h"
#include "core/check.h"
#include "core/random.h"
#include "schedules/analysis/can_load.h"

namespace ttf::sim::medium {
namespace {

constexpr std::size_t kListsWaiting = 4;  // for each message of a node, each of the largest size
constexpr std::size_t kOthersWaiting = 64;
constexpr std::int64_t kIntermissionBits = 3, kSecond_ns = 1'000'000'000;

std::size_t room_of(const schedules::model::Cluster& cluster, const schedules::model::CanBus& can, NodeId node) {
  std::size_t frames = kOthersWaiting;
  for (const schedules::model::CanMessage& message : can.messages)
    if (message.sender == node)
      frames += kListsWaiting * static_cast<std::size_t>(cluster.pdu(message.pdu).max_fragments());
  return frames;
}

}  // namespace

std::size_t CanMedium::most_pending(const schedules::model::Cluster& cluster, std::size_t bus,
                                    std::span<const NodeId> nodes) {
  std::size_t frames = 2;  // the last whole frame, and the same once more, taken up bit by bit
  // Each receiver may have a copy of the frame that has just been accepted.
  for (const NodeId node : nodes) frames += room_of(cluster, cluster.can_buses[bus], node) + 1;
  return frames;
}

CanMedium::CanMedium(const schedules::model::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes,
                     MediumQueue& queue, FramePool& pool, recording::records::Sink& sink, std::uint64_t seed,
                     std::uint32_t replication)
    : cluster_(cluster), bus_(bus), queue_(queue), pool_(pool), sink_(sink),
      line_(cluster.can_buses[bus], nodes.size() + (cluster.can_buses[bus].other_load > 0.0 ? 1 : 0)),
      inverted_for_(line_.size()) {
  std::size_t room = 0;
  for (const NodeId node : nodes) {
    Member& member = members_.emplace_back();
    member.node = node;
    member.room = room_of(cluster, can(), node);
    room += member.room;
  }
  pending_.reserve(room + 1);  // and a whole frame that is taken up bit by bit
  for (std::size_t m = 0; m < line_.size(); ++m) line_.power_on(m, true, TrueTime{});
  if (can().other_load <= 0.0) return;
  other_length_ = schedules::analysis::can_worst_case(can(), can().flexible_data_rate ? 64 : 8);
  constexpr double kSeldom_ns = 1e15;  // eleven days
  const double period = std::ceil(static_cast<double>(other_length_.ns) / can().other_load);
  other_period_ = {static_cast<std::int64_t>(std::min(period, kSeldom_ns))};
  RandomStream phase({seed, replication, Purpose::kOtherTraffic, static_cast<std::uint16_t>(bus), 0});
  next_other_ = TrueTime{} + Duration{phase.integer(0, other_period_.ns - 1)};
}

std::optional<std::size_t> CanMedium::member_of(NodeId node) const {
  for (std::size_t m = 0; m < members_.size(); ++m)
    if (members_[m].node == node) return m;
  return std::nullopt;
}

bool CanMedium::has(NodeId node) const {
  const auto m = member_of(node);
  return m && members_[*m].on;
}

int CanMedium::waiting(NodeId node, std::uint32_t identifier, TrueTime now) const {
  const auto is_it = [&](const auto& frame) {
    return members_[frame.sender].node == node && frame.identifier == identifier;
  };
  const bool on_the_bus = whole_ && whole_->end > now && is_it(whole_->frame);
  return static_cast<int>(std::count_if(pending_.begin(), pending_.end(), is_it)) + (on_the_bus ? 1 : 0);
}

// Returns whether the nodes of other traffic see an idle bus, or see it so behind the whole frame on it.
bool CanMedium::others_may_begin(TrueTime now) const {
  if (!bits_) return true;
  return are_others_idle() && line_.recessive() && (resting_ || held(now) <= now);
}

// Counts other traffic up to now while no frame here waited, with its frame that is on the bus. Where bits are looked at,
// this happens before each: so controllers that wait see no frame too late.
void CanMedium::pass_others(TrueTime now) {
  if (other_length_ == Duration{} || !others_may_begin(now)) return;
  while (next_other_ <= now && idle_from_ <= now) {
    idle_from_ = std::max(next_other_, idle_from_) + other_length_;
    busy_ += other_length_;
    next_other_ += other_period_;
    if (!bits_ || resting_) continue;
    line_.pass_by(idle_from_);
    schedule_bits();
  }
}

void CanMedium::arbitrate_at(TrueTime when) {
  arbitration_due_ = true;
  MediumEvent event;
  event.kind = MediumEvent::Kind::kCanArbitration;
  event.node = event.channel_or_bus = static_cast<std::uint8_t>(bus_);
  queue_.schedule(when, Phase::kArbitration, event.node, event);
}

void CanMedium::send(NodeId sender, TrueTime now, const bus::ports::CanFrame& frame, bool emitted) {
  const auto m = member_of(sender);
  TTF_CHECK(m.has_value(), "{} is not on {}", cluster_.node(sender).name, can().name);
  Member& member = members_[*m];
  if (!emitted && touched(now + Duration{1}) && !disturbance_->queues_on_can(bus_, sender)) return;
  if (!member.on || member.waiting >= member.room) {
    ++dropped_;
    return;
  }
  ++member.waiting;
  pending_.push_back({*m, next_order_++, frame.identifier, pool_.put(frame.data, 1)});
  if (arbitration_due_) return;
  if (bits_ && (!is_idle(*m) || !line_.recessive())) return;  // the end of a bit decides
  pass_others(now);
  arbitrate_at(std::max(now, idle_from_));
}

bool CanMedium::goes_before(const Pending& a, const Pending& b) {
  if (a.identifier != b.identifier) return a.identifier < b.identifier;
  if (a.sender != b.sender) return a.sender < b.sender;
  return a.order < b.order;
}

// Returns whether some other controller will answer the sender's frame.
bool CanMedium::acknowledged(std::size_t sender) const {
  for (std::size_t m = 0; m < line_.size(); ++m)
    if (m != sender && is_idle(m)) return true;
  return false;
}

void CanMedium::arbitrate(TrueTime now) {
  arbitration_due_ = false;
  if (pending_.empty()) return;
  pass_others(now);
  if (idle_from_ > now) return arbitrate_at(idle_from_);
  leave_bits(now);
  if (bits_ && !line_.recessive()) return;
  // A node offers its oldest frame of an identifier first; across nodes the lowest identifier wins.
  auto winner = pending_.end();
  for (auto frame = pending_.begin(); frame != pending_.end(); ++frame)
    if (is_idle(frame->sender) && (winner == pending_.end() || goes_before(*frame, *winner))) winner = frame;
  if (winner == pending_.end()) return;
  if (!bits_ && send_whole(*winner, now)) {
    forget(winner);
    if (!pending_.empty()) arbitrate_at(idle_from_);
    return;
  }
  if (!bits_) begin_bits(now);
  start_frames(now);
}

// Sends a frame to its end, unless bits have to be looked at before.
bool CanMedium::send_whole(const Pending& frame, TrueTime now) {
  const bus::wire::CanFrameTimes times = bus::wire::can_frame_times(can(), frame.identifier, pool_.bytes(frame.frame));
  if (bit_by_bit_ || !acknowledged(frame.sender) || touched(now + times.idle)) return false;
  const TrueTime accepted = now + times.accepted;
  busy_ += times.idle;
  idle_from_ = now + times.idle;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (m == frame.sender || !is_idle(m)) continue;
    pool_.use(frame.frame, 1);
    schedule_arrival(accepted, {m, frame.sender, frame.identifier, frame.frame}, now);
  }
  report_begin(frame, now, accepted);
  schedule_sent(accepted, frame.sender, now);
  if (whole_) pool_.release(whole_->frame.frame);
  pool_.use(frame.frame, 1);
  whole_ = {frame, now, idle_from_ - Duration{kIntermissionBits * kSecond_ns / can().nominal_bit_rate}, idle_from_};
  return true;
}

void CanMedium::schedule_arrival(TrueTime at, const Arrival& arrival, TrueTime start) {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kCanArrival;
  event.node = static_cast<std::uint8_t>(members_[arrival.receiver].node);
  event.channel_or_bus = static_cast<std::uint8_t>(bus_);
  event.flexible_data_rate = can().flexible_data_rate;
  event.identifier = arrival.identifier;
  event.frame = arrival.frame;
  event.sender = static_cast<std::uint8_t>(members_[arrival.sender].node);
  event.start = start;
  queue_.schedule(at, Phase::kArrival, event.node, event);
}

void CanMedium::schedule_sent(TrueTime at, std::size_t sender, TrueTime start) {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kCanSent;
  event.node = event.sender = static_cast<std::uint8_t>(members_[sender].node);
  event.channel_or_bus = static_cast<std::uint8_t>(bus_);
  event.start = start;
  queue_.schedule(at, Phase::kArrival, event.node, event);
}

void CanMedium::forget(std::vector<Pending>::iterator frame) {
  --members_[frame->sender].waiting;
  pool_.release(frame->frame);
  pending_.erase(frame);
}

void CanMedium::forget_all(std::size_t sender) {
  for (auto frame = pending_.begin(); frame != pending_.end();)
    if (frame->sender == sender)
      forget(frame);  // erases it
    else
      ++frame;
}

void CanMedium::report_begin(const Pending& frame, TrueTime start, TrueTime end) {
  recording::records::CanFrameSent sent;
  sent.bus = static_cast<std::uint8_t>(bus_);
  sent.start.true_time = start;
  sent.end.true_time = end;
  sent.start.node = sent.end.node = members_[frame.sender].node;
  sent.identifier = frame.identifier;
  sent.flexible_data_rate = can().flexible_data_rate;
  sent.data = pool_.bytes(frame.frame);
  sink_.on(sent);
}

}  // namespace ttf::sim::medium
