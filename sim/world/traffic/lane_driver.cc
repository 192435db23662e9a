#include "sim/world/traffic/lane_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ttf::sim::world::traffic {
namespace {

constexpr double kGrid_s = 0.01;
constexpr Duration kTimeGap = Duration::milliseconds(1500);
constexpr double kHardestBraking = 8.0;  // [m/s^2], of one that follows
constexpr double kMostSideways = 0.5;    // a share of the speed
constexpr double kTouching_m = 0.1;      // the smallest gap that counts
constexpr Range<Duration> kChange{Duration::milliseconds(100), Duration::milliseconds(60'000)};
constexpr Range<Duration> kDuration{Duration::milliseconds(1), Duration::milliseconds(3'600'000)};

Manoeuvre load_manoeuvre(YamlMap& yaml, const road::RoadConfig& road) {
  Manoeuvre manoeuvre;
  manoeuvre.duration = yaml.duration("duration", kDuration);
  manoeuvre.pace = load_pace(yaml);
  if (yaml.has("lane")) manoeuvre.lane = road::load_lane(yaml, "lane", road);
  manoeuvre.within = yaml.duration_or("within", manoeuvre.within, kChange);
  yaml.finish();
  return manoeuvre;
}

Follow load_follow(YamlMap& yaml) {
  Follow f;
  f.speed = yaml.number_or("speed", f.speed, {0.1, 100.0}, "m/s");
  f.time_gap = yaml.duration_or("time_gap", kTimeGap, {Duration{}, Duration::milliseconds(10'000)}).seconds();
  f.smallest_gap = yaml.number_or("smallest_gap", f.smallest_gap, {0.1, 50.0}, "m");
  f.acceleration = yaml.number_or("acceleration", f.acceleration, {0.1, 10.0}, "m/s^2");
  f.deceleration = yaml.number_or("deceleration", f.deceleration, {0.1, 10.0}, "m/s^2");
  yaml.finish();
  return f;
}

}  // namespace

LaneConfig load_lane_config(YamlMap& object, YamlMap& on, const road::RoadConfig& road) {
  LaneConfig config;
  config.start = road::load_on_lane(on, road);
  for (YamlMap& map : object.maps_if("manoeuvres")) config.manoeuvres.push_back(load_manoeuvre(map, road));
  if (auto follow = object.map_if("follow")) config.follow = load_follow(*follow);
  return config;
}

double following(const Follow& f, double speed, double gap, double ahead) {
  const double wanted =
      f.smallest_gap +
      std::max(0.0, speed * f.time_gap + speed * (speed - ahead) / (2.0 * std::sqrt(f.acceleration * f.deceleration)));
  const double free = std::pow(speed / f.speed, 4), near = wanted / std::max(kTouching_m, gap);
  return std::max(-kHardestBraking, f.acceleration * (1.0 - free - near * near));
}

LaneDriver::LaneDriver(const LaneConfig& config, const road::Road& road, double speed)
    : config_(config), road_(&road), place_{config.start.station, road.middle(config.start.lane)},
      change_(place_.offset), direction_(road::Road::direction(config.start.lane)), speed_(speed) {}

road::Pose LaneDriver::pose() const {
  road::Pose pose = road_->pose_at(place_);
  pose.heading += direction_ < 0.0 ? std::numbers::pi - aside_ : aside_;
  return pose;
}

double LaneDriver::wanted(Duration now, std::span<const Vehicle> others, std::size_t self) {
  if (!begun_ && !config_.manoeuvres.empty()) end_ = config_.manoeuvres.front().duration;
  while (manoeuvre_ < config_.manoeuvres.size() && (!begun_ || now >= end_)) {
    if (begun_) {
      if (++manoeuvre_ == config_.manoeuvres.size()) break;
      end_ = end_ + config_.manoeuvres[manoeuvre_].duration;
    }
    begun_ = true;
    const Manoeuvre& manoeuvre = config_.manoeuvres[manoeuvre_];
    if (manoeuvre.lane) change_.begin(road_->middle(*manoeuvre.lane), manoeuvre.within);
  }
  if (manoeuvre_ < config_.manoeuvres.size())
    if (const Pace& pace = config_.manoeuvres[manoeuvre_].pace; pace.is_said()) return pace.wanted(speed_, kGrid_s);
  if (!config_.follow) return 0.0;
  const Vehicle& own = others[self];
  double gap = std::numeric_limits<double>::infinity(), ahead = 0.0;
  for (std::size_t o = 0; o < others.size(); ++o) {
    const Vehicle& other = others[o];
    if (o == self || std::abs(other.place.offset - own.place.offset) > 0.5 * (other.width + own.width)) continue;
    const double way = direction_ * road_->ahead(place_.station, other.place.station),
                 between = way - 0.5 * (other.length + own.length);
    if (way <= 0.0 || between >= gap) continue;
    gap = between;
    ahead = direction_ * other.direction * other.speed;
  }
  return following(*config_.follow, speed_, gap, ahead);
}

void LaneDriver::advance(double acceleration, double seconds) {
  const double end = std::max(0.0, speed_ + acceleration * seconds), way = 0.5 * (speed_ + end) * seconds;
  const double sideways = std::abs(change_.rate()), most = kMostSideways * 0.5 * (speed_ + end);
  const double before = change_.offset();
  change_.advance(sideways > most ? seconds * most / sideways : seconds);
  const double across = std::clamp(change_.offset() - before, -way, way);
  // Along the line: the way's share, on a circle about the line's centre of curvature. The curvature is that of the middle.
  const double along = std::sqrt(std::max(0.0, way * way - across * across)), offset = before + 0.5 * across;
  const double middle = place_.station + direction_ * 0.5 * along;
  place_.station += direction_ * along / std::max(0.05, 1.0 - road_->line_at(middle).curvature * offset);
  place_.offset = change_.offset();
  speed_ = end;
  if (speed_ > 0.0) aside_ = std::asin(std::clamp(change_.rate() / speed_, -kMostSideways, kMostSideways));
}

}  // namespace ttf::sim::world::traffic
