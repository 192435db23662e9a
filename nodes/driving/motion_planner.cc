#include "nodes/driving/motion_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ttf::nodes::driving {
namespace {

constexpr double kClosest_m = 0.5;  // an object nearer than this fills the picture

// One axis of the picture: a span about the middle, grown and moved into -half..half.
struct Span {
  double low = 0.0, high = 0.0;
};
Span within(Span box, double half, double least) {
  const double middle = 0.5 * (box.low + box.high);
  const double reach = std::min(half, std::max(0.5 * (box.high - box.low), 0.5 * least));
  const double centre = std::clamp(middle, reach - half, half - reach);
  return {centre - reach, centre + reach};
}

}  // namespace

std::optional<vision::Region> region_of(const Picture& picture, const InterestConfig& config,
                                        const recording::records::ImageObject& object) {
  const double c = std::cos(picture.heading), s = std::sin(picture.heading);
  const double dx = object.x - picture.x, dy = object.y - picture.y;
  const double x = c * dx + s * dy, y = -s * dx + c * dy, turned = object.heading - picture.heading;
  const double along = std::cos(turned), across = std::sin(turned);
  double depth = std::numeric_limits<double>::infinity();
  Span columns{depth, -depth};
  for (const double l : {-0.5 * object.length, 0.5 * object.length})
    for (const double w : {-0.5 * object.width, 0.5 * object.width}) {
      const double ahead = x + l * along - w * across, aside = y + l * across + w * along;
      if (ahead < kClosest_m) return std::nullopt;
      depth = std::min(depth, ahead);
      const double column = -picture.focal_px * aside / ahead;
      columns = {std::min(columns.low, column), std::max(columns.high, column)};
    }
  Span rows{picture.focal_px * (picture.height_m - config.object_height_m) / depth,
            picture.focal_px * picture.height_m / depth};
  const double column = 0.5 * (columns.low + columns.high), row = 0.5 * (rows.low + rows.high);
  if (std::abs(column) > picture.half_width_px || std::abs(row) > picture.half_height_px) return std::nullopt;
  const auto widened = [&](Span box) { return Span{box.low - config.margin_px, box.high + config.margin_px}; };
  const double share = std::sqrt(config.least_area);
  columns = within(widened(columns), picture.half_width_px, 2.0 * share * picture.half_width_px);
  rows = within(widened(rows), picture.half_height_px, 2.0 * share * picture.half_height_px);
  return vision::Region{picture.sensor, columns.low, rows.low, columns.high - columns.low, rows.high - rows.low, true};
}

PlannerConfig load_planner(YamlMap& yaml) {
  PlannerConfig c;
  control::GapPlannerConfig& law = c.law;
  law.cruise_mps = yaml.number_or("cruise_speed", law.cruise_mps, {0.0, 100.0}, "m/s");
  law.start_mps = yaml.number_or("start_speed", law.start_mps, {0.0, 100.0}, "m/s");
  law.smallest_gap_m = yaml.number_or("smallest_gap", law.smallest_gap_m, {0.0, 500.0}, "m");
  law.largest_gap_m = yaml.number_or("largest_gap", law.largest_gap_m, {0.0, 500.0}, "m");
  if (law.largest_gap_m < law.smallest_gap_m) yaml.fail("largest_gap", "must be at least `smallest_gap`");
  law.speed_step_mps = yaml.number_or("speed_step", law.speed_step_mps, {0.0, 20.0}, "m/s");
  law.emergency_mps = yaml.number_or("emergency_speed", law.emergency_mps, {0.0, 100.0}, "m/s");
  law.start_up_s =
      yaml.duration_or("start_up", Duration::milliseconds(2'500), {Duration{}, Duration::milliseconds(3'600'000)})
          .seconds();
  c.lane_width_m = yaml.number_or("lane_width", c.lane_width_m, {1.0, 20.0}, "m");
  c.path.max_image_age = yaml.duration_or("max_image_age", c.path.max_image_age,
                                          {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  if (auto region = yaml.map_if("region")) {
    c.interest.margin_px = region->number_or("margin", c.interest.margin_px, {0.0, 10'000.0}, "px");
    c.interest.least_area = region->number_or("least_area", c.interest.least_area, {0.0, 1.0});
    c.interest.object_height_m = region->number_or("object_height", c.interest.object_height_m, {0.1, 5.0}, "m");
    region->finish();
  }
  return c;
}

MotionPlanner::MotionPlanner(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                             const PlannerConfig& config, std::vector<Picture> pictures)
    : config_(config), pictures_(std::move(pictures)), way_(cluster, task, config.path), place_(cluster, task),
      plan_(cluster, task) {
  if (std::ranges::any_of(task.writes, [](const auto& port) { return port.port == "regions"; }))
    regions_.emplace(cluster, task);
  objects_.reserve(way_.most_objects());
  candidates_.reserve(way_.most_objects());
}

std::optional<MotionPlanner::Chosen> MotionPlanner::most_important(const PoseOnLine& own) {
  const double c = std::cos(own.heading), s = std::sin(own.heading);
  candidates_.clear();
  for (const recording::records::ImageObject& object : objects_) {
    const double turned = own.heading + object.heading;
    const double reach = 0.5 * (object.length * std::abs(std::cos(turned)) + object.width * std::abs(std::sin(turned)));
    candidates_.push_back({c * object.x - s * object.y - reach - config_.path.front_m,
                           own.offset + s * object.x + c * object.y,
                           has(object.status, recording::records::ImageStatus::kConfirmed)});
  }
  const double edge = 0.5 * (config_.lane_width_m + config_.width_m);
  const auto found = control::most_important(candidates_, -edge, edge);
  if (!found) return std::nullopt;
  const double speed = objects_[*found].speed * std::cos(own.heading + objects_[*found].heading);
  return Chosen{*found, {candidates_[*found].x, speed}};
}

void MotionPlanner::report_region(host::StepContext& context, const std::optional<Chosen>& chosen,
                                  recording::records::PlanMade& record) {
  std::optional<vision::Region> region;
  for (std::size_t i = 0; chosen && !region && i < pictures_.size(); ++i)
    region = region_of(pictures_[i], config_.interest, objects_[chosen->index]);
  if (region) {
    record.camera = region->sensor;
    record.region = {region->x, region->y, region->width, region->height};
  }
  if (regions_) regions_->issue(context, region ? std::span(&*region, 1) : std::span<const vision::Region>());
}

void MotionPlanner::run(host::StepContext& context) {
  if (!start_) start_ = context.stamp.local;
  const std::optional<double> speed = way_.own_speed(context);
  const std::optional<PoseOnLine> own = place_.look(context);
  recording::records::PlanMade record;
  if (!speed || !own) {
    memory_.speed.reset();
    report_region(context, std::nullopt, record);
    const bool stops = memory_.state == control::PlannerState::kStop;
    return plan_.issue(context, {stops, 0.0, memory_.state}, record);
  }
  way_.list(context, objects_);
  const std::optional<Chosen> chosen = most_important(*own);
  const double asked = control::planned_speed(config_.law, (context.stamp.local - *start_).seconds(),
                                              chosen ? std::optional(chosen->object) : std::nullopt, memory_);
  record.own_speed = *speed;
  record.along = own->along;
  record.offset = own->offset;
  record.heading = own->heading;
  if (chosen) {
    record.track = objects_[chosen->index].track;
    record.gap = chosen->object.gap;
    record.speed_ahead = chosen->object.speed;
  }
  report_region(context, chosen, record);
  plan_.issue(context, {true, std::max(0.0, asked), memory_.state}, record);
}

}  // namespace ttf::nodes::driving
