#include "sensors/in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "core/check.h"

namespace ttf::sensors {
namespace {

using fusion::sensors::Field;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kNarrowest_rad = 1e-12;  // a narrower sector is rounding

bool is_blind(const Field& field, double azimuth) {
  for (std::size_t i = 0; i < field.blind_sectors; ++i)
    if (BlindSector{field.blind[i].from, field.blind[i].to}.holds(azimuth)) return true;
  return false;
}

bool holds_origin(const ObjectState& object) {
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  return std::abs(c * object.x + s * object.y) <= 0.5 * object.length &&
         std::abs(-s * object.x + c * object.y) <= 0.5 * object.width;
}

// An outline beside the origin spans less than half a turn, and its centre lies within. So the cross products of corners say
// which are the outermost.
AzimuthSpan span_about(const ObjectState& object, double bearing) {
  Corner low{1.0, 0.0}, high{1.0, 0.0};  // along the centre's direction and across it
  for (const Corner& corner : corners(object)) {
    const Corner turned{object.x * corner.x + object.y * corner.y, object.x * corner.y - object.y * corner.x};
    if (low.x * turned.y - low.y * turned.x < 0.0) low = turned;
    if (high.x * turned.y - high.y * turned.x > 0.0) high = turned;
  }
  return {bearing + std::atan2(low.y, low.x), bearing + std::atan2(high.y, high.x)};
}

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

// The direction and the circle about an outline: no less than its half angle, no more than half a turn.
struct Circle {
  double distance, reach, bearing, half;
};
Circle circle_about(const ObjectState& object) {
  const double distance = length_of(object.x, object.y), reach = 0.5 * length_of(object.length, object.width);
  // asin(t) <= t pi / 2
  const double half = distance > reach ? 0.5 * std::numbers::pi * reach / distance : std::numbers::pi;
  return {distance, reach, std::atan2(object.y, object.x), half};
}

}  // namespace

InView::InView(std::vector<SensorView> sensors, std::size_t most_objects)
    : sensors_(std::move(sensors)), most_(most_objects) {
  std::stable_partition(sensors_.begin(), sensors_.end(),
                        [](const SensorView& sensor) { return sensor.field.shadow == 0.0; });
  constexpr std::size_t kPieces = 2, kCutsOfAPiece = 2,
                        kCutsOfAnOutline = 16;  // an edge crosses each of two circles twice
  seen_.reserve(most_);
  objects_.reserve(most_);
  for (auto* list : {&cuts_, &rays_})
    list->reserve((kPieces * kCutsOfAPiece + kCutsOfAnOutline) * most_ + 2 * Field::kMostBlind + 2);
  silhouettes_.reserve(kPieces * most_);
  crossed_.reserve(kPieces * most_);
  met_.reserve(kPieces * most_);
}

std::span<const char> InView::of(std::span<const ObjectState> objects) {
  TTF_CHECK(objects.size() <= most_, "{} objects", objects.size());
  seen_.assign(objects.size(), 0);
  for (const SensorView& sensor : sensors_) {
    if (std::ranges::find(seen_, 0) == seen_.end()) break;
    look(sensor, objects);
  }
  return seen_;
}

void InView::look(const SensorView& sensor, std::span<const ObjectState> objects) {
  const Field& field = sensor.field;
  objects_.assign(objects.begin(), objects.end());
  see_from(sensor.placement, objects_);
  silhouettes_.clear();
  cuts_.clear();
  double farthest = 0.0;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    if (!seen_[i]) farthest = std::max(farthest, add_unseen(field, i));
  if (silhouettes_.empty()) return;
  if (field.shadow > 0.0) add_hiding(farthest);
  std::sort(silhouettes_.begin(), silhouettes_.end(), [](const Silhouette& a, const Silhouette& b) {
    return std::tie(a.low, a.object) < std::tie(b.low, b.object);
  });
  aim_at_middles();
  cast(field);
  if (!any_unseen()) return;
  aim_at_sectors(field);
  cast(field);
}

// Returns the largest distance at which a ray can meet the outline, 0 if none can. Where nothing hides, the ray to its centre
// mostly decides at once.
double InView::add_unseen(const Field& field, std::size_t object) {
  const ObjectState& state = objects_[object];
  const double half_field = std::min(field.half_angle, std::numbers::pi);
  const Circle circle = circle_about(state);
  if (circle.distance - circle.reach > field.max_range || std::abs(circle.bearing) - circle.half > half_field ||
      holds_origin(state))
    return 0.0;
  if (field.shadow == 0.0 && std::abs(circle.bearing) <= half_field && circle.distance <= field.max_range &&
      circle.distance - circle.reach >= field.min_range && !is_blind(field, circle.bearing)) {
    seen_[object] = 1;
    return 0.0;
  }
  if (!add_silhouette(object, span_about(state, circle.bearing), -half_field, half_field)) return 0.0;
  if (circle.distance + circle.reach > field.max_range) cut_at_range(field.max_range, state);
  if (circle.distance - circle.reach < field.min_range) cut_at_range(field.min_range, state);
  return circle.distance + circle.reach;
}

// Adds the outlines that may hide one without a view: they are no farther, and lie in its direction.
void InView::add_hiding(double farthest) {
  double low = silhouettes_.front().low, high = silhouettes_.front().high;
  for (const Silhouette& one : silhouettes_) {
    low = std::min(low, one.low);
    high = std::max(high, one.high);
  }
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!seen_[i]) continue;
    const Circle circle = circle_about(objects_[i]);
    const double apart = std::abs(circle.bearing - middle);
    if (circle.distance - circle.reach > farthest || std::min(apart, kTurn - apart) > half + circle.half ||
        holds_origin(objects_[i]))
      continue;
    add_silhouette(i, span_about(objects_[i], circle.bearing), low, high);
  }
}

// Adds the parts from `from` to `to`, in -pi..pi. Returns whether there is one.
bool InView::add_silhouette(std::size_t object, const AzimuthSpan& span, double from, double to) {
  const std::size_t before = silhouettes_.size();
  for (const double turn : {-kTurn, 0.0, kTurn}) {
    const double low = std::max(span.low + turn, from), high = std::min(span.high + turn, to);
    if (high - low < kNarrowest_rad) continue;
    const double middle = std::clamp(0.5 * (span.low + span.high) + turn, low, high);
    silhouettes_.push_back({low, middle, high, object, RayTarget(objects_[object])});
  }
  return silhouettes_.size() > before;
}

// Each edge from a to b: |a + t (b - a)|^2 = range^2.
void InView::cut_at_range(double range, const ObjectState& object) {
  const std::array<Corner, 4> ends = corners(object);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Corner &a = ends[i], &b = ends[(i + 1) % ends.size()];
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double square = dx * dx + dy * dy, along = a.x * dx + a.y * dy;
    const double root = along * along - square * (a.x * a.x + a.y * a.y - range * range);
    if (square == 0.0 || root < 0.0) continue;
    for (const double sign : {-1.0, 1.0}) {
      const double t = (-along + sign * std::sqrt(root)) / square;
      if (t >= 0.0 && t <= 1.0) cuts_.push_back(std::atan2(a.y + t * dy, a.x + t * dx));
    }
  }
}

void InView::aim_at_middles() {
  rays_.clear();
  for (const Silhouette& one : silhouettes_)
    if (!seen_[one.object]) rays_.push_back(one.middle);
  std::sort(rays_.begin(), rays_.end());
}

void InView::aim_at_sectors(const Field& field) {
  for (const Silhouette& one : silhouettes_) {
    cuts_.push_back(one.low);
    cuts_.push_back(one.high);
  }
  for (std::size_t i = 0; i < field.blind_sectors; ++i)
    for (const double edge : {field.blind[i].from, field.blind[i].to}) cuts_.push_back(std::remainder(edge, kTurn));
  std::sort(cuts_.begin(), cuts_.end());
  rays_.clear();
  for (std::size_t i = 1; i < cuts_.size(); ++i)
    if (cuts_[i] - cuts_[i - 1] >= kNarrowest_rad) rays_.push_back(0.5 * (cuts_[i - 1] + cuts_[i]));
}

// Casts the rays in the order of their azimuths. Those that can only meet objects that are in view are left out.
void InView::cast(const Field& field) {
  crossed_.clear();
  std::size_t next = 0;
  for (const double azimuth : rays_) {
    for (; next < silhouettes_.size() && silhouettes_[next].low <= azimuth; ++next) crossed_.push_back(next);
    std::erase_if(crossed_, [&](std::size_t i) { return silhouettes_[i].high < azimuth; });
    if (std::ranges::all_of(crossed_, [&](std::size_t i) { return seen_[silhouettes_[i].object]; }) ||
        is_blind(field, azimuth))
      continue;
    met_.clear();
    for (const std::size_t i : crossed_)
      if (const auto range = silhouettes_[i].target.ray_to(azimuth)) met_.push_back({*range, silhouettes_[i].object});
    note(field);
  }
}

// The last of the nearer outlines has the shadow that reaches furthest.
void InView::note(const Field& field) {
  std::sort(met_.begin(), met_.end(), [](const Meeting& a, const Meeting& b) {
    return std::tie(a.range, a.object) < std::tie(b.range, b.object);
  });
  std::optional<double> nearer;
  for (std::size_t i = 0; i < met_.size(); ++i) {
    const double range = met_[i].range;
    if (i > 0 && met_[i - 1].range < range) nearer = met_[i - 1].range;
    const bool hidden = nearer && range < *nearer * (1.0 + field.shadow);
    if (!hidden && range >= field.min_range && range <= field.max_range) seen_[met_[i].object] = 1;
  }
}

bool InView::any_unseen() const {
  return std::ranges::any_of(silhouettes_, [&](const Silhouette& one) { return !seen_[one.object]; });
}

}  // namespace ttf::sensors
