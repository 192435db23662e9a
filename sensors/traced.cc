#include "sensors/traced.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "sim/world/traffic/classes.h"

namespace ttf::sensors {
namespace {

using recording::osi::TracedKind;
using recording::osi::TracedObject;
using recording::osi::TracedState;

double turned(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

// Returns the state at a part of the way from `a` to `b`, which takes `gap` seconds.
TracedState on_the_way(const TracedState& a, const TracedState& b, double part, double gap) {
  const double s = part, r = 1.0 - s;
  const auto hermite = [&](double from, double slope, double to, double last_slope) {
    return (1.0 + 2.0 * s) * r * r * from + s * r * r * gap * slope + s * s * (3.0 - 2.0 * s) * to -
           s * s * r * gap * last_slope;
  };
  const auto straight = [&](double from, double to) { return from + s * (to - from); };
  return {hermite(a.x, a.vx, b.x, b.vx),
          hermite(a.y, a.vy, b.y, b.vy),
          a.heading + s * turned(b.heading - a.heading),
          straight(a.vx, b.vx),
          straight(a.vy, b.vy),
          straight(a.ax, b.ax),
          straight(a.ay, b.ay),
          straight(a.yaw_rate, b.yaw_rate)};
}

// A trace's vehicle may be a truck, which its size shows, and a radar sees as a car.
sim::world::traffic::ObjectClass class_of(TracedKind kind) {
  using sim::world::traffic::ObjectClass;
  switch (kind) {
    case TracedKind::kTwoWheeler: return ObjectClass::kMotorbike;
    case TracedKind::kPedestrian: return ObjectClass::kPedestrian;
    case TracedKind::kVehicle:
    case TracedKind::kOther: break;
  }
  return ObjectClass::kCar;
}

}  // namespace

TracedScene::TracedScene(std::shared_ptr<const recording::osi::TruthTrace> trace, TrueTime start)
    : trace_(std::move(trace)), start_(start) {
  TTF_CHECK(trace_ && !trace_->instants.empty(), "a trace without messages");
}

TracedScene::Between TracedScene::between(TrueTime at) const {
  const std::vector<Duration>& instants = trace_->instants;
  const Duration since = std::clamp(at - start_, instants.front(), instants.back());
  const auto next = std::upper_bound(instants.begin(), instants.end(), since);
  const auto message = static_cast<std::size_t>(next - instants.begin()) - 1;
  if (next == instants.end()) return {message, 0.0, 0.0};
  const double gap = (*next - instants[message]).seconds();
  return {message, (since - instants[message]).seconds() / gap, gap};
}

std::optional<TracedState> TracedScene::state_of(const TracedObject& object, const Between& at) const {
  for (const TracedObject::Life& life : object.lives) {
    if (at.message < life.first) return std::nullopt;
    const std::size_t k = at.message - life.first;
    if (k >= life.states.size()) continue;
    if (at.part == 0.0) return life.states[k];
    if (k + 1 == life.states.size()) return std::nullopt;
    return on_the_way(life.states[k], life.states[k + 1], at.part, at.gap);
  }
  return std::nullopt;
}

// The middle of the rear axle is the vehicle's origin. Its velocity is that of the box' middle plus w x r. Its
// acceleration is without the angular acceleration's part, which acts along x only for an axle beside the middle.
sim::world::EgoState TracedScene::ego_at(const Between& at) const {
  if (!trace_->host) return {};
  const recording::osi::TracedHost& host = *trace_->host;
  const std::optional<TracedState> middle = state_of(host.vehicle, at);
  TTF_CHECK(middle, "the host vehicle is not in message {}", at.message);
  const double c = std::cos(middle->heading), s = std::sin(middle->heading), w = middle->yaw_rate;
  sim::world::EgoState ego;
  ego.x = middle->x + c * host.rear_x - s * host.rear_y;
  ego.y = middle->y + s * host.rear_x + c * host.rear_y;
  ego.heading = turned(middle->heading);
  ego.vx = c * middle->vx + s * middle->vy - w * host.rear_y;
  ego.vy = c * middle->vy - s * middle->vx + w * host.rear_x;
  ego.yaw_rate = w;
  ego.acceleration = c * middle->ax + s * middle->ay - w * w * host.rear_x;
  return ego;
}

sim::world::EgoState TracedScene::ego_at(TrueTime at) const { return ego_at(between(at)); }

void TracedScene::states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const {
  out.clear();
  const Between instant = between(at);
  const sim::world::EgoState ego = ego_at(instant);
  const double c = std::cos(ego.heading), s = std::sin(ego.heading);
  for (std::size_t o = 0; o < trace_->objects.size(); ++o) {
    const TracedObject& object = trace_->objects[o];
    const std::optional<TracedState> is = state_of(object, instant);
    if (!is) continue;
    const double along = std::cos(is->heading), across = std::sin(is->heading);
    sim::world::ObjectState state;
    state.id = static_cast<ObjectId>(o);
    state.x = c * (is->x - ego.x) + s * (is->y - ego.y);
    state.y = c * (is->y - ego.y) - s * (is->x - ego.x);
    state.heading = turned(is->heading - ego.heading);
    state.speed = along * is->vx + across * is->vy;
    state.acceleration = state.steady = along * is->ax + across * is->ay;
    state.yaw_rate = is->yaw_rate;
    state.length = object.length;
    state.width = object.width;
    state.kind = class_of(object.kind);
    const sim::world::traffic::ClassTraits& traits = sim::world::traffic::traits_of(state.kind);
    state.height = traits.height;
    state.cross_section = traits.cross_section;
    out.push_back(state);
  }
}

}  // namespace ttf::sensors
