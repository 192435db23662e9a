#include "tests/experiments/cost/loops.h"

#include <cmath>

#include "nodes/control/time_gap.h"

namespace ttf::experiments::cost {
namespace {

// -K (1 + Td / h (z - 1) / z).
StateSpace proportional_derivative(double k, double td, double h) {
  return {matrix(1, 1, {0.0}), matrix(1, 1, {1.0}), matrix(1, 1, {k * td / h}), matrix(1, 1, {-k * (td / h + 1.0)})};
}

// Linear between the points, and beyond them as at the end.
double interpolated(const double (&x)[6], const double (&y)[6], double at) {
  int i = 0;
  while (i < 4 && at > x[i + 1]) ++i;
  return y[i] + (y[i + 1] - y[i]) * (at - x[i]) / (x[i + 1] - x[i]);
}

// The gains for a delay.
StateSpace scheduled(double delay, double h) {
  constexpr double kDelay[] = {0.0, 0.0035, 0.0045, 0.0055, 0.0065, 0.0075};
  constexpr double kK[] = {1.5, 1.2, 1.1, 0.98, 0.86, 0.78}, kTd[] = {0.035, 0.040, 0.042, 0.046, 0.049, 0.052};
  return proportional_derivative(interpolated(kDelay, kK, delay), interpolated(kDelay, kTd, delay), h);
}

// -K (1 + 1 / (Ti s) + Td s / (1 + s Td / N)) with the poles and zeros at exp(s h), and the same gain at s = 0.1 / h.
StateSpace matched_pid(double h) {
  constexpr double k = -0.2, ti = 10.0, td = 1.0, n = 10.0;
  // -k (n2 s^2 + n1 s + n0) / (s (s + p)).
  constexpr double p = n / td, n2 = 1.0 + n, n1 = p + 1.0 / ti, n0 = p / ti, s = 0.1;
  const double root = std::sqrt(n1 * n1 - 4.0 * n2 * n0);
  const double zero = (-n1 + root) / (2.0 * n2), other = (-n1 - root) / (2.0 * n2), at = s / h;
  const double z1 = std::exp(zero * h), z2 = std::exp(other * h), pole = std::exp(-p * h), z = std::exp(s);
  const double gain =
      -k * n2 * (at - zero) * (at - other) / (at * (at + p)) * (z - 1.0) * (z - pole) / ((z - z1) * (z - z2));
  const double a1 = -(1.0 + pole), a0 = pole, b1 = -(z1 + z2), b0 = z1 * z2;
  return {matrix(2, 2, {-a1, -a0, 1.0, 0.0}), matrix(2, 1, {1.0, 0.0}),
          matrix(1, 2, {gain * (b1 - a1), gain * (b0 - a0)}), matrix(1, 1, {gain})};
}

}  // namespace

ExpectedCost servo(double h, int total, ServoDelays delays, double loss) {
  ControlLoop loop;
  constexpr Block kPlant = 0, kSampler = 1, kController = 2, kActuator = 3;
  loop.add_plant({matrix(2, 2, {-1.0, 0.0, 1.0, 0.0}), matrix(2, 1, {1000.0, 0.0}), matrix(1, 2, {0.0, 1.0}), {}},
                 {kActuator}, 1.0);
  loop.add_discrete(gains({1.0}), {kPlant});
  loop.add_discrete(proportional_derivative(1.5, 0.035, h), {kSampler});
  loop.add_discrete(gains({1.0}), {kController});
  loop.add_cost(kPlant, 1.0);
  loop.add_cost(kActuator, 1.0);
  std::vector<Jump> control{loop.executes({kController})};
  const double grain = h / 40.0;
  // The controller has the age of its measurement. It expects half of the longest delay behind it. Without age it has the
  // usual gains, as in distributed.m.
  if (delays == ServoDelays::kCompensated)
    for (int age = 1; age <= total / 2; ++age)
      control.push_back(loop.executes_as(kController, scheduled((age + 0.25 * total) * grain, h)));
  const Delays delay = delays == ServoDelays::kConstant ? constant_delay(total / 2) : uniform_delay(0, total / 2);
  return expected_cost(
      loop.flow(),
      {grain,
       40,
       {{{loop.executes({kSampler})}, delay}, {control, with_loss(delay, loss)}, {{loop.executes({kActuator})}, {}}}});
}

ExpectedCost kushner(const Delays& delay) {
  ControlLoop loop;
  constexpr Block kPlant = 0, kSampler = 1, kActuator = 2;
  loop.add_plant({matrix(2, 2, {-3.0, -2.0, 1.0, 0.0}), matrix(2, 1, {6.0, 0.0}), matrix(1, 2, {0.0, 1.0}), {}},
                 {kActuator}, 1.0);
  loop.add_discrete(gains({1.0}), {kPlant});
  loop.add_discrete(gains({-1.0}), {kSampler});
  loop.add_cost(kPlant, 1.0);
  return expected_cost(loop.flow(),
                       {1.42 / 50.0, 50, {{{loop.executes({kSampler})}, delay}, {{loop.executes({kActuator})}, {}}}});
}

ExpectedCost ball_and_beam(BeamRates rates) {
  constexpr double h = 0.1;
  ControlLoop loop;
  constexpr Block kAngle = 0, kBall = 1, kOuter = 2, kInner = 3;
  loop.add_plant({matrix(1, 1, {0.0}), matrix(1, 1, {4.4}), matrix(1, 1, {1.0}), {}}, {kInner}, 1.0);
  loop.add_plant({matrix(2, 2, {0.0, 0.0, 1.0, 0.0}), matrix(2, 1, {-9.0, 0.0}), matrix(1, 2, {0.0, 1.0}), {}},
                 {kAngle});
  loop.add_discrete(matched_pid(rates == BeamRates::kBothFast ? h / 2.0 : h), {kBall});
  loop.add_discrete(gains({4.0, -4.0}), {kOuter, kAngle});
  loop.add_cost(kAngle, 1.0);
  loop.add_cost(kBall, 1.0);
  Timing timing{h / 2.0, rates == BeamRates::kBothFast ? 1 : 2, {{{loop.executes({kOuter, kInner})}, {}}}};
  if (rates == BeamRates::kMultirate) {
    timing.stages[0].next = constant_delay(1);
    timing.stages.push_back({{loop.executes({kInner})}, {}});
  }
  return expected_cost(loop.flow(), timing);
}

Following follow(int periods, const Delays& delay, const FollowingLoop& of) {
  constexpr nodes::control::TimeGapConfig law;
  constexpr double k1 = law.gap_gain, k2 = law.speed_gain, period = 0.04;
  const double gap = of.time_gap_s, lag = of.lag_s, memory = of.memory_s;
  const auto mean_square = [&](bool of_gap) {
    ControlLoop loop;
    constexpr Block kLead = 0, kCar = 1, kClosing = 2, kAcceleration = 3, kNothing = 4, kActuator = 5, kSampler = 6;
    loop.add_plant({matrix(1, 1, {-1.0 / memory}), matrix(1, 1, {1.0}), matrix(1, 1, {1.0}), {}}, {kNothing}, 1.0);
    // Clearance, speed and acceleration, less those of steady following. The output is the gap's error.
    loop.add_plant({matrix(3, 3, {0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0 / lag}),
                    matrix(3, 2, {0.0, 1.0, 0.0, 0.0, 1.0 / lag, 0.0}),
                    matrix(1, 3, {1.0, -gap, 0.0}),
                    {}},
                   {kActuator, kLead});
    loop.add_output(kCar, matrix(1, 3, {0.0, -1.0, 0.0}));
    loop.add_output(kCar, matrix(1, 3, {0.0, 0.0, 1.0}));
    loop.add_discrete(gains({0.0}), {kLead});
    loop.add_discrete(gains({1.0}), {kSampler + static_cast<Block>(periods)});
    loop.add_discrete(gains({k1, k2, k2}), {kCar, kClosing, kLead});
    // Samples move on by one block a period.
    for (int old = 1; old <= periods; ++old) loop.add_discrete(gains({1.0}), {kSampler + static_cast<Block>(old) - 1});
    std::vector<Block> sampling{kNothing};
    for (int old = periods; old >= 0; --old) sampling.push_back(kSampler + static_cast<Block>(old));
    loop.add_cost(of_gap ? kCar : kAcceleration, 1.0);
    return expected_cost(loop.flow(), {period / of.grains,
                                       of.grains,
                                       {{{loop.executes(sampling)}, delay}, {{loop.executes({kActuator})}, {}}}})
        .cost;
  };
  return {std::sqrt(mean_square(true)), std::sqrt(mean_square(false))};
}

}  // namespace ttf::experiments::cost
