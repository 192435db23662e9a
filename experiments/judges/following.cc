#include "experiments/judges/following.h"

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "core/check.h"
#include "experiments/cost/control_loop.h"
#include "experiments/cost/timetable.h"
#include "nodes/control/time_gap.h"

namespace ttf::experiments::judges {
namespace {

using cost::Block;
using cost::gains;
using cost::StateSpace;
using Eigen::MatrixXd;

// By rows.
MatrixXd rows(int count, int columns, std::initializer_list<double> values) {
  MatrixXd result(count, columns);
  int at = 0;
  for (const double value : values) {
    result(at / columns, at % columns) = value;
    ++at;
  }
  return result;
}

// The loop with as many samples in store as the oldest one that a command rests on.
class FollowingLoop {
 public:
  FollowingLoop(const FollowingVehicle& of, int stored) : stored_(stored) {
    constexpr nodes::control::TimeGapConfig law;
    constexpr double k1 = law.gap_gain, k2 = law.speed_gain;
    loop_.add_plant({rows(1, 1, {-1.0 / of.memory_s}), rows(1, 1, {1.0}), rows(1, 1, {1.0}), {}}, {kNothing},
                    of.density);
    // Clearance, speed and acceleration, less those of steady following. The output is the gap's error.
    loop_.add_plant({rows(3, 3, {0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0 / of.lag_s}),
                     rows(3, 2, {0.0, 1.0, 0.0, 0.0, 1.0 / of.lag_s, 0.0}),
                     rows(1, 3, {1.0, -of.time_gap_s, 0.0}),
                     {}},
                    {kActuator, kLead});
    loop_.add_output(kCar, rows(1, 3, {0.0, -1.0, 0.0}));
    loop_.add_discrete(gains({0.0}), {kLead});
    std::vector<Block> samples;
    for (int old = 0; old <= stored; ++old) samples.push_back(kSampler + static_cast<Block>(old));
    loop_.add_discrete(taking(0), samples);
    loop_.add_discrete(gains({k1, k2, k2}), {kCar, kClosing, kLead});
    for (int old = 1; old <= stored; ++old) loop_.add_discrete(gains({1.0}), {kSampler + static_cast<Block>(old) - 1});
    loop_.add_cost(kCar, 1.0);
  }

  cost::Flow flow() const { return loop_.flow(); }
  cost::Jump samples() const {
    std::vector<Block> order{kNothing};
    for (int old = stored_; old >= 0; --old) order.push_back(kSampler + static_cast<Block>(old));
    return loop_.executes(order);
  }
  // The command that rests on the sample so many before the newest.
  cost::Jump acts(int old) const { return loop_.executes_as(kActuator, taking(old)); }

 private:
  static constexpr Block kLead = 0, kCar = 1, kClosing = 2, kNothing = 3, kActuator = 4, kSampler = 5;

  StateSpace taking(int old) const {
    std::vector<double> of_samples(static_cast<std::size_t>(stored_) + 1, 0.0);
    of_samples[static_cast<std::size_t>(old)] = 1.0;
    return gains(of_samples);
  }

  int stored_;
  cost::ControlLoop loop_;
};

struct Event {
  std::int64_t at = 0;
  int old = -1;  // a command's sample, counted back from the newest; -1: a sample is taken
};

// Returns how many samples are taken behind `from`, up to `to`.
int samples_between(const CommandRound& round, std::int64_t from, std::int64_t to) {
  const std::int64_t length = round.length.ns;
  const auto until = [&](std::int64_t at, std::int64_t sample) {
    const std::int64_t behind = at - sample;
    return (behind - ((behind % length + length) % length)) / length;
  };
  std::int64_t count = 0;
  for (const Duration sample : round.samples) count += until(to, sample.ns) - until(from, sample.ns);
  return static_cast<int>(count);
}

}  // namespace

double gap_error(const FollowingVehicle& vehicle, const CommandRound& round) {
  TTF_CHECK(!round.samples.empty() && !round.commands.empty(), "a loop without samples or commands");
  const std::int64_t start = round.samples.front().ns, length = round.length.ns;
  std::vector<Event> events;
  for (const Duration sample : round.samples) events.push_back({sample.ns - start, -1});
  int stored = 0;
  for (const Command& command : round.commands) {
    const int old = samples_between(round, command.sampled.ns, command.at.ns);
    stored = std::max(stored, old);
    events.push_back({((command.at.ns - start) % length + length) % length, old});
  }
  // At one instant the sample is taken first.
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::pair{a.at, a.old >= 0} < std::pair{b.at, b.old >= 0};
  });
  const FollowingLoop loop(vehicle, stored);
  std::vector<cost::TimedJump> jumps;
  for (const Event& event : events)
    jumps.push_back({static_cast<double>(event.at) * 1e-9, event.old < 0 ? loop.samples() : loop.acts(event.old)});
  return cost::timetable_cost(loop.flow(), round.length.seconds(), jumps);
}

}  // namespace ttf::experiments::judges
