#include "nodes/vision/adaptive_camera.h"

#include <utility>

#include "schedules/sequence/history.h"

namespace ttf::nodes::vision {
namespace {

FramePlanConfig with_steps(FramePlanConfig plan, Duration step) {
  plan.shortest = schedules::sequence::occupied({}, step);
  return plan;
}

}  // namespace

AdaptiveCamera::AdaptiveCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras,
                               const DetectionKey& key)
    : step_(cluster.cycle() * task.activation.at.repetition), holds_(step_ * (task.holds.ns / step_.ns)),
      plan_(with_steps(config.plan, step_), static_cast<int>(cameras.size())), shares_(cameras.size()),
      looking_(cluster, task, config, std::move(cameras), key, step_) {}

void AdaptiveCamera::run(host::StepContext& context) {
  if (!context.global_time) return;  // pictures have no age
  looking_.read_regions(context);
  if (work_ && --work_->steps_left <= 0) finish(context);
  if (!work_) begin(context);
}

void AdaptiveCamera::finish(host::StepContext& context) {
  const Work work = *work_;
  work_.reset();
  // A task that missed executions may not write what is older than the schedule says.
  if (context.stamp.local - work.begin > holds_ + Duration{step_.ns / 2}) return;
  if (!work.look.record.secondary) plan_.add(static_cast<int>(work.look.camera), work.look.record.took);
  looking_.write(context, work.look);
}

void AdaptiveCamera::begin(host::StepContext& context) {
  // The region of a secondary detection may be gone by now.
  while (!plan_.over() && plan_.next().secondary && !looking_.has_region(static_cast<std::size_t>(plan_.next().sensor)))
    plan_.pass();
  if (plan_.over()) begin_frame(context);
  const schedules::sequence::Detection next = plan_.next();
  begin_detection(context, static_cast<std::size_t>(next.sensor), next.secondary);
  plan_.pass();
}

void AdaptiveCamera::begin_frame(host::StepContext& context) {
  for (std::size_t c = 0; c < shares_.size(); ++c) shares_[c] = looking_.share(c);
  plan_.begin(shares_);
  context.sink->on(recording::records::SequencePlanned{context.stamp, plan_.frame(), plan_.letters(), plan_.bound(),
                                                       plan_.length()});
}

// Begins a detection, if the camera has a picture for it.
void AdaptiveCamera::begin_detection(host::StepContext& context, std::size_t camera, bool secondary) {
  const std::optional<Look> look = looking_.look(context, camera, secondary, holds_);
  if (!look) return;
  work_ = Work{*look, context.stamp.local, schedules::sequence::occupied(look->record.took, step_).ns / step_.ns};
  work_->look.record.frame = plan_.frame();
  work_->look.record.place = static_cast<std::uint16_t>(plan_.place());
}

}  // namespace ttf::nodes::vision
