#include "sim/world/vehicle/driven.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::sim::world::vehicle {
namespace {

constexpr std::int64_t kStateEvery_ns = 10'000'000;
constexpr std::int64_t kStep_ns = 2'000'000;  // kStep_s
constexpr Range<Duration> kLag{Duration{}, Duration::milliseconds(5'000)};

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// A value that approaches `target` with the time constant `lag`: at the end of `dt`, and on average until then.
struct Approach {
  double end, mean;
};
Approach approach(double now, double target, double lag, double dt) {
  if (lag <= 0.0) return {target, target};
  const double left = std::exp(-dt / lag);
  return {target + (now - target) * left, target + (now - target) * (1.0 - left) * lag / dt};
}

}  // namespace

ActuatorConfig load_actuator(YamlMap& yaml) {
  constexpr Range<Duration> kSome{Duration::milliseconds(1), Duration::milliseconds(10'000)};
  ActuatorConfig c;
  c.dead_time = yaml.duration_or("dead_time", c.dead_time, {Duration::milliseconds(1), Duration::milliseconds(2'000)});
  c.dead_time_line = yaml.line("dead_time");
  c.lag = yaml.duration_or("lag", c.lag, kLag);
  c.steering_lag = yaml.duration_or("steering_lag", c.lag, kLag);
  c.gain = yaml.number_or("gain", c.gain, {0.05, 5.0});
  c.largest_acceleration = yaml.number_or("largest_acceleration", c.largest_acceleration, {0.1, 30.0}, "m/s^2");
  c.largest_deceleration = yaml.number_or("largest_deceleration", c.largest_deceleration, {0.1, 30.0}, "m/s^2");
  c.largest_steering = yaml.number_or("largest_steering", c.largest_steering, {0.0, 1.5}, "rad");
  c.oldest = yaml.duration_or("oldest", c.oldest, kSome);
  c.oldest_line = yaml.line("oldest");
  if (auto without = yaml.map_if("without_command")) {
    c.without = without->choice_or(
        "reaction", c.without,
        Choices<WithoutCommand>{
            {"hold", WithoutCommand::kHold}, {"decay", WithoutCommand::kDecay}, {"brake", WithoutCommand::kBrake}});
    c.after = without->duration_or("after", c.after, kSome);
    c.decay = without->duration_or("decay", c.decay, kSome);
    c.deceleration = without->number_or("deceleration", c.deceleration, {0.1, 30.0}, "m/s^2");
    without->finish();
  }
  yaml.finish();
  return c;
}

Driven::Driven(const EgoConfig& config, const road::Road* road, Duration duration)
    : vehicle_(config.vehicle), actuator_(config.actuator.value()),
      most_states_(static_cast<std::size_t>(duration.ns / kStateEvery_ns + 2)) {
  grid_.reserve(most_states_);
  actuations_.reserve(static_cast<std::size_t>(duration.ns / (actuator_.between.ns / 2) + 2));
  grid_.push_back({start_of(config, road)});
}

void Driven::actuate(const Actuation& actuation) {
  const std::int64_t last = actuations_.empty() ? -1 : actuations_.back().from.ns;
  TTF_CHECK(actuation.from.ns > std::max(last, looked_at_),
            "an actuation from {} ns after one from {} ns and a look at {} ns", actuation.from.ns, last, looked_at_);
  TTF_CHECK(actuations_.size() < actuations_.capacity(), "{} actuations", actuations_.size());
  actuations_.push_back(actuation);
}

Inserted Driven::insert(const Actuation& actuation) {
  const std::int64_t from = actuation.from.ns;
  if (from <= 0 || actuations_.size() == actuations_.capacity()) return Inserted::kRefused;
  const auto place = std::ranges::lower_bound(actuations_, actuation.from, {}, &Actuation::from);
  if (place != actuations_.end() && place->from == actuation.from) return Inserted::kKnown;
  actuations_.insert(place, actuation);
  // States up to its instant do not include it yet, so they stay.
  while (grid_.back().at > from) grid_.pop_back();
  return from > looked_at_ ? Inserted::kNew : Inserted::kLate;
}

// Returns the instant from which on the vehicle is without a command, if no other one comes.
std::int64_t Driven::alone_from(const State& state) const {
  return (state.commands == 0 ? 0 : actuations_[state.commands - 1].from.ns) + actuator_.after.ns;
}

// The wheels stay as they are before the first command, and while the actuator brakes by itself.
Driven::Demand Driven::demand(const State& state) const {
  Demand last{0.0, state.motion.steering};
  if (state.commands > 0) {
    const Actuation& newest = actuations_[state.commands - 1];
    last = {std::clamp(newest.acceleration, -actuator_.largest_deceleration, actuator_.largest_acceleration),
            std::clamp(newest.steering, -actuator_.largest_steering, actuator_.largest_steering)};
  }
  const std::int64_t alone = state.at - alone_from(state);
  if (alone < 0) return last;
  switch (actuator_.without) {
    case WithoutCommand::kHold: return last;
    case WithoutCommand::kDecay: {
      const double left = std::exp(-seconds(alone) / actuator_.decay.seconds());
      return {left * last.acceleration, left * last.steering};
    }
    case WithoutCommand::kBrake: return {-actuator_.deceleration, state.motion.steering};
  }
  TTF_CHECK(false, "reaction {}", static_cast<int>(actuator_.without));
}

// Returns the end of the time with one demand, at most `until`.
std::int64_t Driven::next_change(const State& state, std::int64_t until) const {
  std::int64_t next = until;
  if (state.commands < actuations_.size()) next = std::min(next, actuations_[state.commands].from.ns);
  if (const std::int64_t alone = alone_from(state); alone > state.at) next = std::min(next, alone);
  return next;
}

void Driven::step(State& state, std::int64_t ns) const {
  const double dt = seconds(ns);
  const Demand wanted = demand(state);
  const Approach pull = approach(state.pull, actuator_.gain * wanted.acceleration, actuator_.lag.seconds(), dt);
  const Approach wheels =
      approach(state.motion.steering, wanted.steering, actuator_.steering_lag.value_or(actuator_.lag).seconds(), dt);
  const Command command{(wheels.end - state.motion.steering) / dt, std::max(pull.mean, -state.motion.speed / dt)};
  const double before = state.motion.speed;
  state.motion = stepped(vehicle_, state.motion, command, dt);
  if (state.motion.speed < 1e-9) state.motion.speed = 0.0;  // rounding leaves a rest of a standstill
  state.pull = pull.end;
  state.acceleration =
      state.motion.speed > 0.0 ? limited(vehicle_, state.motion.steering, before, {0.0, pull.end}).acceleration : 0.0;
  state.at += ns;
}

Driven::State Driven::advanced_to(State state, std::int64_t until) const {
  while (state.at < until) {
    while (state.commands < actuations_.size() && actuations_[state.commands].from.ns <= state.at) ++state.commands;
    const std::int64_t change = next_change(state, until);
    while (state.at < change) step(state, std::min(kStep_ns, change - state.at));
  }
  return state;
}

RearAxleMotion Driven::at(TrueTime since_start) {
  const std::int64_t at = std::max<std::int64_t>(0, since_start.ns);
  looked_at_ = std::max(looked_at_, at);
  while (grid_.size() < most_states_ && grid_.back().at + kStateEvery_ns <= at)
    grid_.push_back(advanced_to(grid_.back(), grid_.back().at + kStateEvery_ns));
  const auto k = std::min(static_cast<std::size_t>(at / kStateEvery_ns), grid_.size() - 1);
  const State now = advanced_to(grid_[k], at);
  RearAxleMotion motion = rear_axle_motion(vehicle_, now.motion, {0.0, now.acceleration});
  // The model's acceleration at a standstill would be that of the brakes.
  if (now.motion.speed <= 0.0) motion.acceleration = 0.0;
  return motion;
}

}  // namespace ttf::sim::world::vehicle
