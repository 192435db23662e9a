#include "nodes/driving/own_place.h"

#include "nodes/driving/ahead.h"
#include "nodes/host/signals.h"

namespace ttf::nodes::driving {
namespace {

constexpr std::size_t kSamples = 64;

}  // namespace

OwnPlace::OwnPlace(const schedules::model::Cluster& cluster, const schedules::model::Task& task)
    : round_(cluster.round()), odometry_(place_of(task, "odometry")),
      signals_(host::bind_element<4>(cluster, cluster.pdu(task.reads[odometry_].pdu),
                                     {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})),
      path_({}, kSamples) {}

std::optional<PoseOnLine> OwnPlace::look(const host::StepContext& context) {
  if (!context.global_time) return std::nullopt;
  const host::Input& input = context.inputs[odometry_];
  const GlobalTime now = context.stamp.global;
  if (input.fresh && host::element_count(*input.layout, *input.list) > 0) {
    const auto value = [&](std::size_t s) { return host::element_value(*input.layout, *input.list, 0, signals_[s]); };
    path_.accept(
        {host::past_time_stamp(*input.layout, *input.list, now, round_), value(0), value(1), value(2), value(3)});
  }
  if (path_.has_stopped(now)) return std::nullopt;
  const auto own = path_.at(now);
  if (!own) return std::nullopt;
  return PoseOnLine{own->vehicle.position.x(), own->vehicle.position.y(), own->vehicle.yaw, path_.newest().speed,
                    path_.newest().yaw_rate};
}

}  // namespace ttf::nodes::driving
