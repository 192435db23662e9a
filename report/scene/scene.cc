#include "report/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "recording/scene/geometry.h"
#include "report/scene/packed.h"

namespace ttf::report::scene {
namespace {

template <class Object> bool near(const Object& object) {
  return std::abs(object.x) <= SceneSink::kFarthest_m && std::abs(object.y) <= SceneSink::kFarthest_m;
}
float narrow(double value) { return static_cast<float>(value); }

// Moments that must stay however near they are: a warning begins or ends.
template <class Part> bool changes(const Moment<Part>&, const Moment<Part>&) { return false; }
bool changes(const Moment<Warning>& before, const Moment<Warning>& now) {
  return !std::ranges::equal(before.parts, now.parts, {}, &Warning::track, &Warning::track);
}

template <class Part> bool too_near(const Moment<Part>& before, const Moment<Part>& now, Duration spacing) {
  return now.at - before.at < spacing && !changes(before, now);
}

template <class Part> void thin(std::vector<Moment<Part>>& moments, Duration spacing) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (kept > 0 && too_near(moments[kept - 1], moments[i], spacing)) continue;
    if (kept != i) moments[kept] = std::move(moments[i]);
    ++kept;
  }
  moments.erase(moments.begin() + static_cast<std::ptrdiff_t>(kept), moments.end());
}

template <class Part> std::size_t bytes_of(const std::vector<Moment<Part>>& moments) {
  std::size_t sum = 0;
  for (const Moment<Part>& moment : moments) sum += packed_bytes<Part>(moment.parts.size());
  return sum;
}

}  // namespace

std::string Scene::thinned_words() const {
  std::string words;
  if (spacing > Duration{})
    words =
        fmt::format("The scene has no room for every instant: one in {:g} ms of each kind is here.", in_ms(spacing));
  if (cut)
    words += fmt::format(" The scene ends at {:.3g} s, the drive at {:.3g} s.", static_cast<double>(last.ns) * 1e-9,
                         static_cast<double>(end.ns) * 1e-9);
  return words;
}

SceneSink::SceneSink(std::vector<ViewedSensor> sensors, SceneLimits limits) : limits_(limits) {
  scene_.lists.resize(sensors.size());
  scene_.sensors = std::move(sensors);
}

bool SceneSink::takes(TrueTime at) {
  if (at < limits_.from || at > limits_.to) return false;
  scene_.end = std::max(scene_.end, at);
  return !scene_.cut;
}

// The newest moment is nearly always the last one.
template <class Part> void SceneSink::add(std::vector<Moment<Part>>& moments, Moment<Part> moment) {
  auto after = moments.end();
  while (after != moments.begin() && std::prev(after)->at > moment.at) --after;
  if (after != moments.begin()) {
    Moment<Part>& before = *std::prev(after);
    if (before.at == moment.at) return;
    if (too_near(before, moment, scene_.spacing)) return;
  }
  const bool any = scene_.last != TrueTime{} || !scene_.truth.empty() || !scene_.images.empty();
  scene_.first = any ? std::min(scene_.first, moment.at) : moment.at;
  scene_.last = std::max(scene_.last, moment.at);
  bytes_ += packed_bytes<Part>(moment.parts.size());
  moments.insert(after, std::move(moment));
  if (bytes_ > limits_.bytes) make_room();
}

void SceneSink::make_room() {
  while (bytes_ > limits_.bytes) {
    if (scene_.spacing >= kSparsest) {
      scene_.cut = true;
      return;
    }
    scene_.spacing = scene_.spacing == Duration{} ? Duration::milliseconds(20) : Duration{2 * scene_.spacing.ns};
    thin(scene_.truth, scene_.spacing);
    thin(scene_.images, scene_.spacing);
    thin(scene_.own, scene_.spacing);
    thin(scene_.warnings, scene_.spacing);
    bytes_ = bytes_of(scene_.truth) + bytes_of(scene_.images) + bytes_of(scene_.own) + bytes_of(scene_.warnings);
    for (auto& moments : scene_.lists) {
      thin(moments, scene_.spacing);
      bytes_ += bytes_of(moments);
    }
  }
}

void SceneSink::truth(TrueTime at, std::span<const recording::records::TruthState> states) {
  if (!takes(at)) return;
  Moment<TrueObject> moment{at, {}};
  for (const recording::records::TruthState& r : states)
    if (recording::scene::drawable(r) && near(r))
      moment.parts.push_back(
          {r.object, narrow(r.x), narrow(r.y), narrow(r.heading), narrow(r.length), narrow(r.width)});
  add(scene_.truth, std::move(moment));
}

void SceneSink::list(const recording::scene::SeenList& list) {
  if (index_of(list.id.sensor) >= scene_.lists.size() || !takes(list.measured)) return;
  Moment<Point> moment{list.measured, {}};
  std::ranges::copy_if(list.points, std::back_inserter(moment.parts), [](const Point& p) { return near(p); });
  add(scene_.lists[index_of(list.id.sensor)], std::move(moment));
}

void SceneSink::image(TrueTime valid_at, const recording::records::ImageWritten& image) {
  if (!takes(valid_at)) return;
  Moment<ShownTrack> moment{valid_at, {}};
  for (const recording::records::ImageObject& r : image.objects) {
    if (!recording::scene::drawable(r) || !near(r)) continue;
    moment.parts.push_back({r.track, narrow(r.x), narrow(r.y), narrow(r.heading), narrow(r.speed), narrow(r.length),
                            narrow(r.width), narrow(r.sigma_x), narrow(r.sigma_y), narrow(r.correlation_xy), r.status});
  }
  if (own_motion()) add(scene_.own, Moment<OwnMotion>{valid_at, {*own_motion()}});
  add(scene_.images, std::move(moment));
}

void SceneSink::odometry(SensorId sensor) {
  if (index_of(sensor) < scene_.sensors.size()) scene_.sensors[index_of(sensor)].odometry = true;
}

void SceneSink::use(TrueTime at, const recording::records::FeatureUsed& use) {
  if (!takes(at)) return;
  Moment<Warning> moment{at, {}};
  for (const recording::records::FeatureObject& object : use.objects)
    if (object.warning)
      moment.parts.push_back({object.image.track, narrow(object.time_to_collision_s), narrow(object.time_gap_s)});
  const bool warned = !scene_.warnings.empty() && !scene_.warnings.back().parts.empty();
  if (warned || !moment.parts.empty()) add(scene_.warnings, std::move(moment));
}

Scene SceneSink::finished() {
  finish();
  return std::exchange(scene_, {});
}

}  // namespace ttf::report::scene
