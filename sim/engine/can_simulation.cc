#include "sim/engine/can_simulation.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::sim::engine {
namespace {

constexpr std::size_t kPending = 2048;  // events, and frames that wait or are on their way

}  // namespace

CanSimulation::CanSimulation(const schedules::model::Cluster& cluster, std::size_t bus, CanHosts& hosts,
                             recording::records::Sink& sink, std::uint64_t seed, std::uint32_t replication)
    : bus_(bus), hosts_(hosts), queue_(kPending), pool_(kPending),
      medium_(cluster, bus, schedules::model::nodes_on_can(cluster, bus), queue_, pool_, sink, seed, replication) {}

void CanSimulation::set_disturbance(medium::Disturbance* disturbance) {
  disturbance_ = disturbance;
  medium_.set_disturbance(disturbance);
}

void CanSimulation::emit(const medium::Leaving&, std::optional<NodeId>) {
  TTF_CHECK(false, "a signal on FlexRay, at {} ns", now_.ns);
}

void CanSimulation::run_until(TrueTime end) {
  TTF_CHECK(end >= now_, "time goes back from {} to {} ns", now_.ns, end.ns);
  while (true) {
    const TrueTime next = queue_.empty() ? kNever<TrueTime> : queue_.next().time;
    if (disturbance_ != nullptr && disturbance_->next() < next) {
      if (disturbance_->next() > end) break;
      now_ = std::max(now_, disturbance_->next());
      disturbance_->act(now_);
      continue;
    }
    if (next > end || next == kNever<TrueTime>) break;
    now_ = next;
    happen(queue_.pop());
  }
  now_ = end;
}

void CanSimulation::happen(const medium::MediumEvent& event) {
  using Kind = medium::MediumEvent::Kind;
  const auto node = static_cast<NodeId>(event.node);
  switch (event.kind) {
    case Kind::kCanArbitration: return medium_.arbitrate(now_);
    case Kind::kCanBits: return medium_.end_bits(now_);
    case Kind::kCanSent: return hosts_.sent(node);
    case Kind::kCanArrival:
      hosts_.received(node, {event.identifier, event.flexible_data_rate, pool_.bytes(event.frame)});
      return pool_.release(event.frame);
    case Kind::kFlexRayArrival:
    case Kind::kStrobe:
    case Kind::kTrigger:
    case Kind::kObservation: break;
  }
  TTF_CHECK(false, "an event of kind {}", static_cast<int>(event.kind));
}

}  // namespace ttf::sim::engine
