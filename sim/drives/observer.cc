#include "sim/drives/observer.h"

#include <span>
#include <utility>

#include "sim/engine/cluster_simulation.h"

namespace ttf::sim::drives {
namespace {

bool stands_at_origin(const sim::world::EgoState& ego) {
  return ego.x == 0.0 && ego.y == 0.0 && ego.heading == 0.0 && ego.vx == 0.0 && ego.vy == 0.0 && ego.yaw_rate == 0.0 &&
         ego.acceleration == 0.0;
}

}  // namespace

Observer::Observer(const sensors::Scene& scene, std::size_t nodes, recording::records::Sink& out)
    : scene_(scene), out_(out), last_truth_(nodes) {
  states_.reserve(scene.objects());
}

void Observer::follow(const sim::world::Reference& reference, const sim::world::World& world, TrueTime start,
                      bool integrated) {
  reference_ = &reference;
  world_ = &world;
  start_ = start;
  integrated_ = integrated;
}

void Observer::watch(std::vector<sensors::SensorView> sensors) {
  in_view_.emplace(std::move(sensors), scene_.objects());
}

void Observer::on(const recording::records::FusionStep& step) {
  if (reference_ == nullptr) return;
  while (true) {
    const Duration since_start = start_ - TrueTime{};
    // The vehicle may not have been driven as far as a fix to come.
    if (reference_->available(next_fix_) + since_start > step.stamp.true_time) return;
    const sim::world::Fix fix = reference_->fix(next_fix_, *world_);
    recording::records::ReferenceFix record;
    record.measured_true = fix.measured + since_start;
    record.measured_local = LocalTime{record.measured_true.ns};
    record.measured = global_of(record.measured_true, step.stamp);
    record.available = global_of(fix.available + since_start, step.stamp);
    record.object = fix.object;
    record.x = fix.x;
    record.y = fix.y;
    record.sigma = reference_->sigma();
    record.vx = fix.vx;
    record.vy = fix.vy;
    record.sigma_velocity = reference_->velocity_sigma();
    out_.on(record);
    ++next_fix_;
  }
}

// GPS time is the reference's own. In an integrated drive its offset to cycle 0 puts it on the cluster's scale.
// In a cold drive the start and rate of the cluster's time are unknown beforehand: the fusion node's clock at
// the fix is used.
GlobalTime Observer::global_of(TrueTime at, const recording::records::Stamp& fused) const {
  return integrated_ ? GlobalTime{} + (at - sim::engine::kFirstCycle) : fused.global + (at - fused.true_time);
}

void Observer::truth(const recording::records::Stamp& stamp) {
  const TrueTime at = stamp.true_time;
  std::optional<TrueTime>& last = last_truth_[index_of(stamp.node)];
  if (last == at) return;
  last = at;
  const sim::world::EgoState ego = scene_.ego_at(at);
  if (!stands_at_origin(ego))
    out_.on(recording::records::EgoTruth{at, ego.x, ego.y, ego.heading, ego.vx, ego.vy, ego.yaw_rate, ego.acceleration,
                                         stamp.local, stamp.global, stamp.node});
  scene_.states_at(at, states_);
  const std::span<const char> in_view = in_view_ ? in_view_->of(states_) : std::span<const char>();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const sim::world::ObjectState& state = states_[i];
    out_.on(recording::records::TruthState{at, state.id, state.x, state.y, state.heading, state.speed, state.steady,
                                           state.yaw_rate, state.length, state.width, stamp.local, stamp.global,
                                           stamp.node, in_view_ && !in_view[i]});
  }
}

}  // namespace ttf::sim::drives
