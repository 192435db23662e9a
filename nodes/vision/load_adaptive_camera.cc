// The keys of an adaptive camera in a scenario.
#include "nodes/vision/config.h"

namespace ttf::nodes::vision {
namespace {

FixedRegion load_region(YamlMap& yaml) {
  constexpr Range<double> kPlace{-4000.0, 4000.0}, kSize{1.0, 8000.0};
  FixedRegion fixed;
  fixed.line = yaml.line();
  fixed.camera = yaml.text("camera");
  fixed.region.x = yaml.number("x", kPlace, "px");
  fixed.region.y = yaml.number("y", kPlace, "px");
  fixed.region.width = yaml.number("width", kSize, "px");
  fixed.region.height = yaml.number("height", kSize, "px");
  fixed.region.valid = true;
  yaml.finish();
  return fixed;
}

ModeOfRegions load_mode(YamlMap& yaml) {
  ModeOfRegions row;
  row.line = yaml.line();
  row.mode = yaml.text("mode");
  if (yaml.has("regions")) row.cameras = yaml.texts("regions");
  yaml.finish();
  return row;
}

}  // namespace

AdaptiveCameraConfig load_adaptive_camera(YamlMap& yaml) {
  using schedules::sequence::DetectionHistory;
  using schedules::sequence::SlotOrder;
  using schedules::sequence::SlotRule;
  constexpr Range<Duration> kTimes{Duration::milliseconds(1), Duration::milliseconds(10'000)};
  AdaptiveCameraConfig c;
  c.plan.bound = yaml.duration_or("beta", c.plan.bound, {Duration{}, kTimes.high});
  c.plan.slots =
      yaml.choice_or<SlotRule>("slots", c.plan.slots, {{"text", SlotRule::kText}, {"floor", SlotRule::kFloor}});
  c.plan.order = yaml.choice_or<SlotOrder>("order", c.plan.order,
                                           {{"text", SlotOrder::kText}, {"reversed", SlotOrder::kReversed}});
  c.picture_time = yaml.duration_or("picture_time", c.picture_time, kTimes);
  c.deviation = yaml.number_or("deviation", c.deviation, {0.0, 0.5});
  c.hardware_factor = yaml.number_or("hardware_factor", c.hardware_factor, {0.01, 100.0});
  const Duration guess = yaml.duration_or("first_guess", Duration::milliseconds(250), kTimes);
  c.plan.first_guess = Duration{static_cast<std::int64_t>(static_cast<double>(guess.ns) * c.hardware_factor)};
  c.plan.history = static_cast<std::size_t>(
      yaml.integer_or("history", DetectionHistory::kKept, {1, static_cast<std::int64_t>(DetectionHistory::kMostKept)}));
  c.smallest_region_px = yaml.number_or("smallest_region", c.smallest_region_px, {1.0, 8000.0}, "px");
  c.oldest_region = yaml.duration_or("oldest_region", c.oldest_region, kTimes);
  for (YamlMap& map : yaml.maps_if("regions")) c.regions.push_back(load_region(map));
  for (YamlMap& map : yaml.maps_if("modes")) c.modes.push_back(load_mode(map));
  return c;
}

}  // namespace ttf::nodes::vision
