// The expected cost of control loops. Oracles are closed forms, published values and a sampled loop.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "core/random.h"
#include "tests/experiments/cost/expected_cost.h"
#include "tests/experiments/cost/loops.h"

namespace ttf::experiments::cost {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Six significant digits, as Jitterbug prints.
std::string six(double value) { return fmt::format("{:.6g}", value); }

TEST(Flow, RotationAndDoubleIntegratorAreTheirClosedForms) {
  const Eigen::MatrixXd turn = exponential(matrix(2, 2, {0.0, -7.0, 7.0, 0.0}));
  EXPECT_NEAR(turn(0, 0), std::cos(7.0), 1e-13);
  EXPECT_NEAR(turn(1, 0), std::sin(7.0), 1e-13);
  // Position and velocity with white acceleration of density 2, cost of the position's square.
  constexpr double t = 0.7;
  const FlowStep step = step_of(
      {matrix(2, 2, {0.0, 1.0, 0.0, 0.0}), matrix(2, 2, {0.0, 0.0, 0.0, 2.0}), matrix(2, 2, {1.0, 0.0, 0.0, 0.0})}, t);
  EXPECT_NEAR(step.phi(0, 1), t, 1e-14);
  EXPECT_NEAR(step.noise(0, 0), 2.0 * t * t * t / 3.0, 1e-14);
  EXPECT_NEAR(step.noise(0, 1), 2.0 * t * t / 2.0, 1e-14);
  EXPECT_NEAR(step.noise(1, 1), 2.0 * t, 1e-14);
  EXPECT_NEAR(step.q(0, 0), t, 1e-14);
  EXPECT_NEAR(step.q(0, 1), t * t / 2.0, 1e-14);
  EXPECT_NEAR(step.q(1, 1), t * t * t / 3.0, 1e-14);
  EXPECT_NEAR(step.constant, 2.0 * t * t * t * t / 12.0, 1e-14);
}

// dx = u dt + dw with u = -k x (+ n) at the beginning of each period: x+ = (1 - k h) x - k h n + w.
ExpectedCost integrator(double k, double h, double measurement_variance) {
  ControlLoop loop;
  loop.add_plant({matrix(1, 1, {0.0}), matrix(1, 1, {1.0}), matrix(1, 1, {1.0}), {}}, {1}, 1.0, measurement_variance);
  loop.add_discrete(gains({-k}), {0});
  loop.add_cost(0, 1.0);
  return expected_cost(loop.flow(), {h / 7.0, 7, {{{loop.executes({1})}, {}}}});
}

TEST(ExpectedCost, OfAnIntegratorIsItsClosedForm) {
  for (const double k : {0.3, 1.0, 1.9})
    for (const double r : {0.0, 0.4}) {
      constexpr double h = 0.8;
      const double left = 1.0 - k * h, before = (h + r * k * k * h * h) / (1.0 - left * left);
      const double within = before * (1.0 - k * h + k * k * h * h / 3.0) + r * k * k * h * h / 3.0 + h / 2.0;
      EXPECT_NEAR(integrator(k, h, r).cost, within, 1e-12 * within) << k;
      EXPECT_NEAR(integrator(k, h, r).spectral_radius, left * left, 1e-12) << k;
    }
  EXPECT_TRUE(integrator(2.49, 0.8, 0.0).stable());
  EXPECT_EQ(integrator(2.51, 0.8, 0.0).cost, kInfinite);
}

TEST(ExpectedCost, OfBallAndBeamIsThePublishedOne) {
  EXPECT_EQ(fmt::format("{:.4f}", ball_and_beam(BeamRates::kBothSlow).cost), "3.3955");
  EXPECT_EQ(fmt::format("{:.4f}", ball_and_beam(BeamRates::kBothFast).cost), "1.9329");
  EXPECT_EQ(fmt::format("{:.4f}", ball_and_beam(BeamRates::kMultirate).cost), "1.9910");
}

TEST(ExpectedCost, OfTheLoopOfKushnerAndTobiasIsThePublishedOne) {
  const struct {
    int most;
    const char* cost;
  } published[] = {{0, "138.213"}, {4, "10.9028"},  {7, "9.00573"},  {11, "9.246"},
                   {14, "10.723"}, {18, "16.0697"}, {21, "31.0397"}, {28, "inf"}};
  for (const auto& [most, cost] : published) EXPECT_EQ(six(kushner(uniform_delay(0, most)).cost), cost) << most;
}

TEST(ExpectedCost, AgeHelpsTheLoopOfKushnerAndTobiasAndJitterDoesNot) {
  EXPECT_LT(kushner(constant_delay(2)).cost, kushner(constant_delay(0)).cost);
  for (const int mean : {2, 7, 9, 14})
    EXPECT_LT(kushner(constant_delay(mean)).cost, kushner(uniform_delay(0, 2 * mean)).cost) << mean;
  EXPECT_EQ(fmt::format("{:.1f}", kushner(constant_delay(14)).cost), "22.5");
}

// Costs by Jitterbug: no delay, then the largest total of h / 4, h / 2, 3 h / 4 and h.
struct PublishedServo {
  int h_ms;
  const char* cost[13];
};
constexpr PublishedServo kServo[] = {{1,
                                      {"48.4049", "49.1477", "49.9094", "50.6908", "51.4931", "48.7742", "49.1486",
                                       "49.528", "49.9127", "48.6979", "48.9873", "49.279", "49.5732"}},
                                     {2,
                                      {"51.0717", "52.7543", "54.5305", "56.4101", "58.4056", "51.903", "52.7583",
                                       "53.6388", "54.5457", "51.7144", "52.3494", "52.9909", "53.6399"}},
                                     {4,
                                      {"57.4073", "61.8363", "66.8722", "72.6729", "79.4763", "59.5594", "61.8572",
                                       "64.3164", "66.9575", "58.9851", "60.542", "62.1165", "63.712"}},
                                     {6,
                                      {"65.5234", "74.6556", "86.2176", "101.496", "123.023", "69.8564", "74.7205",
                                       "80.2226", "86.5142", "68.5293", "71.4858", "74.4648", "77.4225"}},
                                     {8,
                                      {"76.2399", "94.0195", "120.671", "166.146", "265.6", "84.3762", "94.1929",
                                       "106.284", "121.628", "81.5661", "86.7916", "91.9297", "96.6955"}},
                                     {10,
                                      {"90.9708", "126.499", "198.743", "440.681", "inf", "106.286", "126.962",
                                       "156.473", "202.511", "100.384", "109.638", "118.155", "125.202"}}};

// The page's tables are computed anew.
std::string page() { return read_file(std::string(TTF_SOURCE_DIR) + "/docs/schedules/expected_error.md"); }

TEST(ExpectedCost, OfTheServoIsThePublishedOneAndThePagesTable) {
  const std::string text = page();
  for (const PublishedServo& row : kServo) {
    const double h = 1e-3 * row.h_ms;
    std::vector<std::string> costs{six(servo(h, 0, ServoDelays::kConstant).cost)};
    for (const ServoDelays delays : {ServoDelays::kConstant, ServoDelays::kUniform, ServoDelays::kCompensated})
      for (const int total : {10, 20, 30, 40}) costs.push_back(six(servo(h, total, delays).cost));
    std::string line = fmt::format("| {} |", row.h_ms);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      EXPECT_EQ(costs[i], row.cost[i]) << row.h_ms << " ms, column " << i;
      line += costs[i] == "inf" ? " unstable" : " " + costs[i];
      if (i == 0 || i == 4 || i == 8 || i == 12)
        line += " |";
      else
        line += " /";
    }
    EXPECT_THAT(text, testing::HasSubstr("\n" + line + "\n"));
  }
}

TEST(ExpectedCost, OfAFollowingVehicleIsThePagesTable) {
  const std::string text = page();
  for (const int age : {0, 40, 80, 120, 200}) {
    const int periods = age / 40;
    const Following at = follow(periods, constant_delay(0)), steady = follow(periods, constant_delay(2)),
                    jitter = follow(periods, uniform_delay(0, 4));
    EXPECT_THAT(text, testing::HasSubstr(fmt::format("\n| {} | {:.3f} | {:.3f} | {:.4f} | {:.4f} |\n", age, at.gap_m,
                                                     at.acceleration, steady.gap_m, jitter.gap_m)));
  }
}

// The loop of scenarios/acc_following.yaml, without limits, tracker and noise of sensors. A list is 40 ms old and more.
TEST(ExpectedCost, OfAgeAndJitterIsThePagesTable) {
  const std::string text = page();
  const FollowingLoop loop{1.8, 0.2, 10.0, 8};
  for (const int age : {0, 40, 80, 160}) {
    const auto gap = [&](const Delays& delay) { return follow(1 + age / 40, delay, loop).gap_m; };
    EXPECT_THAT(text,
                testing::HasSubstr(fmt::format("\n| {} | {:.4f} | {:.4f} | {:.4f} |\n", age, gap(constant_delay(3)),
                                               gap(uniform_delay(0, 6)), gap(constant_delay(6)))));
  }
}

// The servo by its draws: states in closed form from grain to grain, a trapezium for the cost, delays and losses drawn.
struct Sampled {
  double mean = 0.0, half_width = 0.0;  // three and a half standard errors
};
Sampled sampled_servo(double h, int total, double loss) {
  constexpr int kGrains = 40, kBatches = 40, kPeriods = 2000;
  RandomStream draws({7});
  const double dt = h / kGrains, f = std::exp(-dt), lost = -std::expm1(-dt);
  const double vv = 0.5e6 * (1.0 - f * f), vy = 0.5e6 * lost * lost, yy = 1e6 * dt * dt * dt / 3.0 * (1.0 - 0.75 * dt);
  double y = 0.0, v = 0.0, sampled = 0.0, before = 0.0, command = 0.0, u = 0.0, sum = 0.0, squares = 0.0;
  for (int batch = -2; batch < kBatches; ++batch) {
    double cost = 0.0;
    for (int period = 0; period < kPeriods; ++period) {
      const std::int64_t control = draws.integer(0, total / 2), act = control + draws.integer(0, total / 2);
      const bool arrives = draws.uniform() >= loss;
      sampled = y;
      for (int grain = 0; grain <= kGrains; ++grain) {
        if (grain == control) {
          const double k = 1.5, td = 0.035;
          command = k * td / h * before - k * (td / h + 1.0) * sampled;
          before = sampled;
        }
        if (grain == act && arrives) u = command;
        if (grain == kGrains) break;
        const double a = draws.normal(), b = draws.normal();
        const double old = y, wv = std::sqrt(vv) * a, wy = vy / std::sqrt(vv) * a + std::sqrt(yy - vy * vy / vv) * b;
        y += lost * v + 1000.0 * u * (dt - lost) + wy;
        v = f * v + 1000.0 * u * lost + wv;
        cost += 0.5 * (old * old + y * y) + u * u;
      }
    }
    if (batch < 0) continue;  // until it is stationary
    const double mean = cost / (kPeriods * kGrains);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / kBatches, variance = (squares - kBatches * mean * mean) / (kBatches - 1);
  return {mean, 3.5 * std::sqrt(variance / kBatches)};
}

TEST(ExpectedCost, IsTheSampledOne) {
  for (const double loss : {0.0, 0.2}) {
    const Sampled sampled = sampled_servo(0.004, 20, loss);
    const double expected = servo(0.004, 20, ServoDelays::kUniform, loss).cost;
    EXPECT_NEAR(sampled.mean, expected, sampled.half_width);
    EXPECT_LT(sampled.half_width, 0.06 * expected) << "too wide to tell";
  }
  EXPECT_GT(servo(0.004, 20, ServoDelays::kUniform, 0.2).cost, 1.05 * servo(0.004, 20, ServoDelays::kUniform).cost);
}

}  // namespace
}  // namespace ttf::experiments::cost
