// The covariance recursion of a schedule: against closed forms, and against the strategies with their tracker
// on drawn measurements.
#include "experiments/sweep/expected_error.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "experiments/results/statistics.h"
#include "fusion/strategies/strategy.h"
#include "schedules/sequence/expected_error.h"
#include "sim/drives/scenario.h"
#include "tests/experiments/sweep/known_lists.h"

namespace ttf::experiments::sweep {
namespace {

using fusion::strategies::StrategyKind;

GlobalTime at_ms(double ms) { return GlobalTime{static_cast<std::int64_t>(std::llround(ms * 1e6))}; }
Look look_at(double ms, double variance) { return {at_ms(ms), variance * Eigen::Matrix2d::Identity()}; }

// Least squares through n points of a line with unknown slope: at the last one 2 (2n - 1) / (n (n + 1)) of R.
TEST(ExpectedError, WithoutNoiseOfMotionItIsThatOfALineThroughAllPoints) {
  ErrorRecursion recursion(PointMotion::known(0.0, 1e4));
  for (int n = 1; n <= 20; ++n) {
    recursion.fuse(look_at(50.0 * n, 0.09));
    const double line = n == 1 ? 1.0 : 2.0 * (2.0 * n - 1.0) / (n * (n + 1.0));
    EXPECT_NEAR(recursion.at(at_ms(50.0 * n))(0, 0), 0.09 * line, 1e-6) << n;
  }
}

// The steady alpha-beta filter of white acceleration, with alpha and beta the gains of position and velocity:
// beta^2 / (1 - alpha) = q T^3 / R and alpha = sqrt(2 beta + beta^2 / 12) - beta / 2 (Bar-Shalom et al.,
// 2001, 6.5.3).
TEST(ExpectedError, SettlesAtTheAlphaBetaFilter) {
  for (const double density : {0.01, 1.0, 30.0})
    for (const double variance : {0.0025, 0.25})
      for (const double period_ms : {10.0, 50.0, 200.0}) {
        ErrorRecursion recursion(PointMotion::known(density, 8.0));
        const int many = 4000;
        for (int n = 0; n <= many; ++n) recursion.fuse(look_at(period_ms * n, variance));
        const Eigen::Matrix4d p = recursion.at(at_ms(period_ms * many));
        const double t = period_ms * 1e-3, alpha = p(0, 0) / variance, beta = t * p(0, 2) / variance;
        EXPECT_NEAR(beta * beta / (1.0 - alpha) / (density * t * t * t / variance), 1.0, 1e-6);
        EXPECT_NEAR(std::sqrt(2.0 * beta + beta * beta / 12.0) - beta / 2.0, alpha, 1e-9);
        EXPECT_NEAR(p(1, 1), p(0, 0), 1e-12);
        EXPECT_EQ(p(0, 1), 0.0);
      }
}

// With ever more frequent measurements, it is the Kalman-Bucy filter with r = R T: sqrt(2) q^(1/4) r^(3/4).
TEST(ExpectedError, MeasuredAllTheTimeItIsTheKalmanBucyFilter) {
  const double density = 2.0, variance = 10.0, t = 1e-4;
  ErrorRecursion recursion(PointMotion::known(density, 1.0));
  for (int n = 0; n <= 40'000; ++n) recursion.fuse({at_ms(0.1 * n), variance * Eigen::Matrix2d::Identity()});
  const Eigen::Matrix4d p = recursion.at(at_ms(0.1 * 40'000));
  EXPECT_NEAR(p(0, 0), std::sqrt(2.0) * std::pow(density, 0.25) * std::pow(variance * t, 0.75), 0.002 * p(0, 0));
  EXPECT_NEAR(p(0, 2), std::sqrt(density * variance * t), 0.002 * p(0, 2));
}

// Detections of unequal intervals, repeated for ever: a sequence has the same error by its own recursion
// (schedules/sequence/expected_error.h). Each result is there when its detection ends.
TEST(ExpectedError, IsThatOfASequenceOfDetections) {
  const schedules::sequence::Sequence frame{{0, false}, {0, true}, {1, false}, {0, true}};
  const schedules::sequence::DetectionTimes times(2, Duration::milliseconds(46), Duration::milliseconds(28));
  const auto found = schedules::sequence::expected_errors(frame, times, {3.0, 0.5});
  for (int sensor = 0; sensor < 2; ++sensor) {
    ErrorRecursion recursion(PointMotion::known(3.0, 8.0));
    double now = 0.0, shown_from = 0.0, mean = 0.0, worst = 0.0;
    const auto variance = [&](double ms) { return recursion.at(at_ms(ms))(0, 0); };
    for (int n = 0; n < 100; ++n) {
      if (n == 99) mean = worst = 0.0;
      for (const schedules::sequence::Detection& detection : frame) {
        const double begins = now;
        now += in_ms(times.of(detection));
        if (detection.sensor != sensor) continue;
        if (n > 0) {  // Simpson's rule is exact for a cubic
          mean += (now - shown_from) / 6.0 *
                  (variance(shown_from) + 4.0 * variance(0.5 * (shown_from + now)) + variance(now));
          worst = std::max(worst, variance(now));
        }
        recursion.fuse(look_at(begins, 0.25));
        shown_from = now;
      }
    }
    const schedules::sequence::ExpectedError& sequence = found[static_cast<std::size_t>(sensor)];
    EXPECT_NEAR(sequence.mean, mean / in_ms(frame_time(frame, times)), 1e-6 * mean);
    EXPECT_NEAR(sequence.worst, worst, 1e-6 * worst);
  }
}

// A wrong assumed density costs accuracy, and the recursion shows it. A right one gives the believed error.
TEST(ExpectedError, AWrongDensityCosts) {
  const auto settled = [](double assumed, double actual) {
    PointMotion motion = PointMotion::known(assumed, 8.0);
    motion.actual = actual * Eigen::Matrix2d::Identity();
    ErrorRecursion recursion(motion);
    for (int n = 0; n < 500; ++n) recursion.fuse(look_at(40.0 * n, 0.04));
    return recursion.at(at_ms(40.0 * 500))(0, 0);
  };
  EXPECT_GT(settled(0.1, 2.0), settled(2.0, 2.0) * 1.1);
  EXPECT_GT(settled(60.0, 2.0), settled(2.0, 2.0) * 1.1);
  EXPECT_LT(settled(2.0, 0.0), settled(2.0, 2.0));
}

// Cars whose speed forgets, sampled. A Kalman filter of one axis follows them. It takes the noise for white. The deviation
// goes in steps of 1 ms.
struct Forgetful {
  static constexpr double kDensity = 8.0, kMemory = 0.15, kNoise = 0.01, kPeriod = 0.04, kSpeed = 5.0, kSigma = 8.0;
  static constexpr int kLists = 30, kRuns = 20'000;

  // By list: the mean square of the error of a prediction by 20 ms.
  static std::vector<double> sampled() {
    constexpr int kFine = 40;
    const double step = kPeriod / kFine, kept = std::exp(-step / kMemory);
    const double stationary = std::sqrt(0.5 * kDensity * kMemory), spread = stationary * std::sqrt(1.0 - kept * kept);
    std::vector<double> squares(kLists);
    for (std::uint32_t run = 0; run < kRuns; ++run) {
      RandomStream motion({21, run, Purpose::kTest, 1, 0}), noise({21, run, Purpose::kTest, 2, 0});
      double u = stationary * motion.normal(), x = 0.0, estimate = 0.0, speed = 0.0, pp = 0.0, pv = 0.0, vv = 0.0;
      for (int n = 0; n < kLists; ++n) {
        const double z = x + std::sqrt(kNoise) * noise.normal();
        if (n == 0) {
          estimate = z;
          pp = kNoise;
          vv = kSigma * kSigma;
        } else {
          const double t = kPeriod, q = kDensity;
          estimate += t * speed;
          pp += 2.0 * t * pv + t * t * vv + q * t * t * t / 3.0;
          pv += t * vv + q * t * t / 2.0;
          vv += q * t;
          const double k = pp / (pp + kNoise), l = pv / (pp + kNoise), off = z - estimate;
          estimate += k * off;
          speed += l * off;
          vv -= l * pv;
          pv *= 1.0 - k;
          pp *= 1.0 - k;
        }
        for (int fine = 0; fine < kFine; ++fine) {
          if (fine == kFine / 2) {
            const double off = x - (estimate + 0.5 * kPeriod * speed);
            squares[static_cast<std::size_t>(n)] += off * off / kRuns;
          }
          const double before = u;
          u = kept * u + spread * motion.normal();
          x += step * (kSpeed + 0.5 * (before + u));
        }
      }
    }
    return squares;
  }

  static double expected(int list, bool forgets) {
    PointMotion motion = PointMotion::known(kDensity, kSigma);
    motion.actual_velocity = Eigen::Vector2d(kSpeed * kSpeed, 0.0).asDiagonal();
    if (forgets) {
      motion.actual.setZero();
      motion.forgotten = Eigen::Vector2d(kDensity, 0.0).asDiagonal();
      motion.memory = kMemory;
    }
    ErrorRecursion recursion(motion);
    for (int n = 0; n <= list; ++n) recursion.fuse(look_at(1e3 * kPeriod * n, kNoise));
    return recursion.at(at_ms(1e3 * kPeriod * (list + 0.5)))(0, 0);
  }
};

TEST(ExpectedError, OfASpeedThatForgetsItIsTheSampledOne) {
  const std::vector<double> sampled = Forgetful::sampled();
  // A mean of n squares spreads by sqrt(2 / n) of itself.
  for (const int list : {0, 1, 3, 10, 29}) {
    const double expected = Forgetful::expected(list, true);
    EXPECT_NEAR(sampled[static_cast<std::size_t>(list)] / expected, 1.0, 4.0 * std::sqrt(2.0 / Forgetful::kRuns))
        << list;
  }
  EXPECT_LT(Forgetful::expected(29, true), 0.9 * Forgetful::expected(29, false)) << "the memory makes no difference";
}

TEST(ExpectedError, ALongMemoryIsNone) {
  for (const double density : {0.1, 10.0}) {
    PointMotion white = PointMotion::known(density, 8.0), forgets = white;
    forgets.actual.setZero();
    forgets.forgotten = white.actual;
    forgets.memory = 1e5;
    // It is stationary: most of the speed is in the part that it forgets.
    white.actual_velocity = forgets.forgotten * (0.5 * forgets.memory);
    forgets.actual_velocity.setZero();
    ErrorRecursion a(white), b(forgets);
    for (int n = 0; n <= 40; ++n)
      for (ErrorRecursion* recursion : {&a, &b}) recursion->fuse(look_at(40.0 * n, 0.04));
    EXPECT_NEAR(b.at(at_ms(1650.0))(0, 0) / a.at(at_ms(1650.0))(0, 0), 1.0, 1e-3);
    EXPECT_NEAR(b.at(at_ms(1650.0))(2, 2) / a.at(at_ms(1650.0))(2, 2), 1.0, 1e-3);
  }
}

TEST(ExpectedError, OrderOfArrivalDoesNotMatterInTheEnd) {
  ErrorRecursion in_order(PointMotion::known(3.0, 8.0)), late(PointMotion::known(3.0, 8.0));
  for (const double ms : {0.0, 40.0, 80.0, 120.0}) in_order.fuse(look_at(ms, 0.04 + ms * 1e-4));
  for (const double ms : {80.0, 0.0, 120.0, 40.0}) late.fuse(look_at(ms, 0.04 + ms * 1e-4));
  EXPECT_EQ(in_order.at(at_ms(150.0)), late.at(at_ms(150.0)));
}

// Two sensors as in the paper, whose lists overtake each other.
struct Drawn {
  std::vector<ListTimes> lists;
  std::vector<Duration> longest{Duration::milliseconds(70), Duration::milliseconds(45)};
  std::vector<Duration> periods{Duration::milliseconds(80), Duration::milliseconds(42)};
  std::vector<double> variances{0.01, 0.09};
};
Drawn drawn_lists(double until_ms) {
  Drawn drawn;
  for (std::uint16_t s = 0; s < 2; ++s) {
    RandomStream delays({7, 0, Purpose::kTest, s, 0});
    const double period = drawn.periods[s].seconds() * 1e3, most = drawn.longest[s].seconds() * 1e3;
    GlobalTime before{};
    for (int n = 0; period * n + 3.0 * s < until_ms; ++n) {
      const GlobalTime measured = at_ms(period * n + 3.0 * s);
      // A sensor's own lists do not overtake each other.
      before = std::max(before, measured + (at_ms(delays.uniform(0.3 * most, most)) - GlobalTime{}));
      drawn.lists.push_back({static_cast<SensorId>(s), measured, before});
    }
  }
  std::stable_sort(drawn.lists.begin(), drawn.lists.end(),
                   [](const ListTimes& a, const ListTimes& b) { return a.arrival < b.arrival; });
  return drawn;
}

// A replication through a strategy, with queries at separate instants. One object, a position a list.
class Sampled {
 public:
  static constexpr double kDensity = 3.0;

  Sampled(StrategyKind kind, const Drawn& drawn) : drawn_(drawn) {
    tracker_.process_noise = kDensity;
    tracker_.gate_probability = 0.9999999;  // the recursion has no gate
    std::vector<fusion::strategies::SensorTiming> timings;
    for (std::size_t s = 0; s < 2; ++s)
      timings.push_back({static_cast<SensorId>(s), fusion::strategies::Settling::after(drawn.longest[s]), true,
                         at_ms(3.0 * static_cast<double>(s)), drawn.periods[s]});
    strategy_ = fusion::strategies::make_strategy(kind, tracker_, timings);
  }

  // The instants at which lists are fused, as drawn.lists, and the squared errors at the uses.
  void drive(std::uint32_t replication, std::span<const Use> uses, std::vector<GlobalTime>& fused,
             std::vector<std::optional<double>>& squares) {
    draw(replication, uses);
    fused.assign(drawn_.lists.size(), GlobalTime{});
    std::vector<fusion::tracks::TrackView> image;
    auto use = uses.begin();
    std::size_t next = 0;
    while (next < drawn_.lists.size() || strategy_->next_release()) {
      // Arrivals, releases and uses in order; a use sees everything fused at its instant.
      GlobalTime now = next < drawn_.lists.size() ? drawn_.lists[next].arrival : *strategy_->next_release();
      if (const auto release = strategy_->next_release()) now = std::min(now, *release);
      for (; use != uses.end() && use->known < now; ++use) squares.push_back(square_at(*use, image));
      for (; next < drawn_.lists.size() && drawn_.lists[next].arrival == now; ++next) accept(next);
      strategy_->fuse(now);
      for (const fusion::strategies::FusedList& list : strategy_->last_fused())
        if (list.disposition != fusion::strategies::Disposition::kHeld) fused[list.id.sequence] = now;
    }
    for (; use != uses.end(); ++use) squares.push_back(square_at(*use, image));
  }

 private:
  // The object at all needed instants, exactly with this density, and the sensors' measurements of it.
  void draw(std::uint32_t replication, std::span<const Use> uses) {
    std::vector<GlobalTime> instants;
    for (const ListTimes& list : drawn_.lists) instants.push_back(list.measured);
    for (const Use& use : uses) instants.push_back(use.at);
    std::sort(instants.begin(), instants.end());
    RandomStream motion({11, replication, Purpose::kTest, 9, 0});
    Eigen::Vector2d position(30.0, 2.0), velocity(8.0 * motion.normal(), 8.0 * motion.normal());
    truth_.clear();
    GlobalTime now = instants.front();
    for (const GlobalTime instant : instants) {
      const double dt = (instant - now).seconds();
      now = instant;
      position += dt * velocity;
      for (int axis = 0; axis < 2 && dt > 0.0; ++axis) {
        const double a = motion.normal(), b = motion.normal(), root = std::sqrt(kDensity * dt);
        velocity(axis) += root * a;
        position(axis) += root * dt * (0.5 * a + b / std::sqrt(12.0));
      }
      truth_.emplace_back(instant, position);
    }
    replication_ = replication;
  }
  Eigen::Vector2d truth_at(GlobalTime at) const {
    return std::find_if(truth_.begin(), truth_.end(), [&](const auto& one) { return one.first == at; })->second;
  }

  void accept(std::size_t l) {
    const ListTimes& list = drawn_.lists[l];
    RandomStream noise(
        {12, replication_, Purpose::kTest, static_cast<std::uint16_t>(list.sensor), static_cast<std::uint32_t>(l)});
    const double variance = drawn_.variances[index_of(list.sensor)];
    fusion::sensors::Observation observation;
    observation.sensor = list.sensor;
    observation.z.head<2>() =
        truth_at(list.measured) + std::sqrt(variance) * Eigen::Vector2d(noise.normal(), noise.normal());
    observation.r.topLeftCorner<2, 2>() = variance * Eigen::Matrix2d::Identity();
    strategy_->accept({{list.sensor, static_cast<std::uint32_t>(l)}, list.measured, {&observation, 1}});
  }

  std::optional<double> square_at(const Use& use, std::vector<fusion::tracks::TrackView>& image) const {
    strategy_->image(use.at, image);
    if (image.size() != 1) return std::nullopt;
    return (image.front().state.head<2>() - truth_at(use.at)).squaredNorm();
  }

  const Drawn& drawn_;
  fusion::config::TrackerConfig tracker_;
  std::unique_ptr<fusion::strategies::Strategy> strategy_;
  std::vector<std::pair<GlobalTime, Eigen::Vector2d>> truth_;
  std::uint32_t replication_ = 0;
};

std::vector<Use> uses_every_40_ms(double from_ms, double to_ms) {
  std::vector<Use> uses;
  for (double ms = from_ms; ms < to_ms; ms += 40.0) uses.push_back({at_ms(ms), at_ms(ms + 8.0)});
  return uses;
}

class AgainstStrategies : public testing::TestWithParam<StrategyKind> {};

// The predicted fusion instants are the strategies'.
TEST_P(AgainstStrategies, ListsAreFusedWhenSaid) {
  const Drawn drawn = drawn_lists(3000.0);
  Sampled sampled(GetParam(), drawn);
  std::vector<GlobalTime> fused;
  std::vector<std::optional<double>> squares;
  sampled.drive(0, {}, fused, squares);
  EXPECT_EQ(fused, fused_at(GetParam(), drawn.lists, drawn.longest));
  std::size_t later = 0;
  for (std::size_t l = 0; l < fused.size(); ++l) later += fused[l] > drawn.lists[l].arrival;
  EXPECT_EQ(GetParam() == StrategyKind::kAdva, later == 0u);
}

// 4,000 drives of 2 s: the mean square of the error, over the uses from 0.6 s on, has the expected one in its interval;
// a drive counts once, for its errors hang together.
TEST_P(AgainstStrategies, TheErrorIsTheExpectedOne) {
  const Drawn drawn = drawn_lists(2000.0);
  const std::vector<Use> uses = uses_every_40_ms(600.0, 2000.0);
  std::vector<Look> looks;
  for (const ListTimes& list : drawn.lists)
    looks.push_back({list.measured, drawn.variances[index_of(list.sensor)] * Eigen::Matrix2d::Identity()});
  const auto fused = fused_at(GetParam(), drawn.lists, drawn.longest);
  const auto errors = expected_errors(PointMotion::known(Sampled::kDensity, 8.0), looks, fused, uses);
  double expected = 0.0;
  for (const Eigen::Matrix4d& error : errors)
    expected += error.topLeftCorner<2, 2>().trace() / static_cast<double>(uses.size());

  results::Moments moments;
  for (std::uint32_t replication = 0; replication < 4000; ++replication) {
    Sampled sampled(GetParam(), drawn);
    std::vector<GlobalTime> as_fused;
    std::vector<std::optional<double>> squares;
    sampled.drive(replication, uses, as_fused, squares);
    ASSERT_EQ(squares.size(), uses.size());
    double sum = 0.0;
    for (const auto& square : squares) {
      ASSERT_TRUE(square) << "no image, or more than one object, in replication " << replication;
      sum += *square;
    }
    moments.add(sum / static_cast<double>(uses.size()));
  }
  const results::Interval interval = results::interval_of(moments, 0.99);
  EXPECT_LT(interval.low(), expected);
  EXPECT_GT(interval.high(), expected);
  EXPECT_LT(interval.half_width, 0.02 * expected) << "too wide to say anything";
  RecordProperty("expected_m2", std::to_string(expected));
  RecordProperty("sampled_m2", std::to_string(interval.mean) + " +- " + std::to_string(interval.half_width));
}

INSTANTIATE_TEST_SUITE_P(Strategies, AgainstStrategies, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& one) { return std::string(name_of(one.param)); });

// The variance of the predicted position, averaged over time, for two equal, settled sensors of one period.
// The other one is `phase` (0 to 1) of the period behind. A list is known after `delay_ms`.
double average_variance(double density, double variance, double period_ms, double phase, double delay_ms) {
  constexpr int kPeriods = 400, kSteps = 20;
  std::vector<Look> looks;
  std::vector<GlobalTime> fused;
  for (int n = 0; n <= kPeriods; ++n)
    for (const double begin : {period_ms * n, period_ms * (n + phase)}) {
      looks.push_back(look_at(begin, variance));
      fused.push_back(at_ms(begin + delay_ms));
    }
  // From the last but one list of the first sensor on. Between two lists the error grows as a cubic
  // polynomial, whose mean Simpson's rule gives exactly.
  double sum = 0.0;
  const double begin = period_ms * (kPeriods - 1) + delay_ms;
  for (const auto& [from, to] : {std::pair{0.0, phase}, std::pair{phase, 1.0}}) {
    if (from == to) continue;
    std::vector<Use> uses;
    for (int k = 0; k <= kSteps; ++k) {
      const GlobalTime at = at_ms(begin + period_ms * (from + (to - from) * k / kSteps));
      // A list that comes at its end is not known yet.
      uses.push_back({k < kSteps ? std::max(at, at_ms(begin + period_ms * from)) : at - Duration{1000}, at});
    }
    const auto errors = expected_errors(PointMotion::known(density, 8.0), looks, fused, uses);
    for (int k = 0; k <= kSteps; ++k) {
      const double weight = k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += (to - from) * errors[static_cast<std::size_t>(k)](0, 0) * weight / (3.0 * kSteps);
    }
  }
  return sum;
}

// Niu, Varshney, Mehrotra, Mohan: "Temporally staggered sensors in multi-sensor target tracking systems",
// IEEE Transactions on Aerospace and Electronic Systems 41, 2005. Evenly staggered sensors of equal noise
// leave less error on the average over time than synchronous ones. With two sensors, the error falls the more
// even they are.
TEST(SchedulePhases, EvenlyStaggeredSensorsLeaveLessErrorThanSynchronousOnes) {
  double least = 1.0, most = 0.0;
  for (const double density : {0.01, 0.1, 1.0, 10.0, 100.0})
    for (const double sigma : {0.02, 0.1, 0.5, 2.0})
      for (const double period_ms : {20.0, 80.0, 320.0})
        for (const double delay_ms : {0.0, 40.0}) {
          const auto of = [&](double phase) {
            return average_variance(density, sigma * sigma, period_ms, phase, delay_ms);
          };
          const double synchronous = of(0.0), quarter = of(0.25), even = of(0.5);
          EXPECT_LT(even, synchronous) << density << " " << sigma << " " << period_ms << " " << delay_ms;
          EXPECT_LT(even, quarter) << density << " " << sigma << " " << period_ms << " " << delay_ms;
          EXPECT_LT(quarter, synchronous) << density << " " << sigma << " " << period_ms << " " << delay_ms;
          EXPECT_NEAR(of(0.75), quarter, 1e-6 * quarter);
          least = std::min(least, even / synchronous);
          most = std::max(most, even / synchronous);
        }
  RecordProperty("even_by_synchronous", std::to_string(least) + " to " + std::to_string(most));
}

// This holds on average only. A use at one instant of the period is best off with both lists right before it.
TEST(SchedulePhases, AskedAtOneInstantOnlySynchronousSensorsAreBetter) {
  const auto used_late = [](double phase) {
    std::vector<Look> looks;
    std::vector<GlobalTime> fused;
    for (int n = 0; n < 200; ++n)
      for (const double begin : {80.0 * n, 80.0 * (n + phase)}) {
        looks.push_back(look_at(begin, 0.01));
        fused.push_back(at_ms(begin));
      }
    const Use use{at_ms(80.0 * 199), at_ms(80.0 * 199)};
    return expected_errors(PointMotion::known(10.0, 8.0), looks, fused, {&use, 1}).front()(0, 0);
  };
  EXPECT_LT(used_late(0.0), used_late(0.5));
}

}  // namespace
}  // namespace ttf::experiments::sweep
