// Bounds from below over all phases: drawn phases never fall below them, and they come close to the least.
#include "experiments/judges/least_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "experiments/judges/trial_path.h"

namespace ttf::experiments::judges {
namespace {

double drawn_between(RandomStream& draws, double low, double high) {
  return low * std::pow(high / low, draws.uniform());
}

// The error of streams that are first used at these ages.
double error_at_ages(const Possible& possible, const std::vector<Duration>& ages, double density) {
  Duration length = possible.every;
  for (const Stream& stream : possible.streams) length = std::max(length, stream.period);
  Round round{length, {}, {}, {}};
  for (Duration use{}; use < length; use += possible.every) round.uses.push_back(use);
  for (std::size_t s = 0; s < ages.size(); ++s)
    for (Duration start{}; start < length; start += possible.streams[s].period)
      round.sightings.push_back({start - ages[s], possible.streams[s].variance, start, {}});
  return mean_error(round, Motion::kConstantVelocity, density);
}

TEST(LeastOverPhases, IsBelowAllAgesAndCloseToTheLeast) {
  RandomStream draws({22});
  for (int draw = 0; draw < 12; ++draw) {
    const Duration period = Duration::milliseconds(draws.integer(20, 60));
    Possible possible{period, {}, {}, {}};
    for (int s = 0; s < 2; ++s)
      possible.streams.push_back(
          {drawn_between(draws, 1e-3, 0.1), period, Duration::milliseconds(draws.integer(20, 90))});
    const double density = drawn_between(draws, 0.01, 30.0);
    const auto bounded = [&](const Round& round) {
      return bounded_mean_error(round, Motion::kConstantVelocity, density);
    };
    const double bound = least_over_phases(possible, bounded, 1e9, 3'000);
    double least = 1e9;
    for (int a = 0; a < 24; ++a)
      for (int b = 0; b < 24; ++b)
        least = std::min(least, error_at_ages(possible,
                                              {possible.streams[0].least_age + Duration{period.ns * a / 12},
                                               possible.streams[1].least_age + Duration{period.ns * b / 12}},
                                              density));
    EXPECT_LE(bound, least) << draw;
    EXPECT_GE(bound, 0.97 * least) << draw;
  }
}

// A sensor that measures half as often, and one that measures twice as often as it is used.
TEST(LeastOverPhases, HoldsForOtherPeriods) {
  for (const int factor : {2, 4}) {
    Possible possible{Duration::milliseconds(20), {}, {}, {}};
    possible.streams.push_back({0.01, Duration::milliseconds(20 * factor), Duration::milliseconds(30)});
    possible.streams.push_back({0.04, Duration::milliseconds(20), Duration::milliseconds(25)});
    const auto bounded = [](const Round& round) { return bounded_mean_error(round, Motion::kConstantVelocity, 2.0); };
    const double bound = least_over_phases(possible, bounded, 1e9, 2'000);
    double least = 1e9;
    for (int a = 0; a < 8 * factor; ++a)
      for (int b = 0; b < 8; ++b) {
        // An age of a slow sensor is that of its first use: it waits for less than one use.
        const std::vector<Duration> ages{Duration{30'000'000 + 2'500'000 * (a % 8)},
                                         Duration{25'000'000 + 2'500'000 * b}};
        least = std::min(least, error_at_ages(possible, ages, 2.0));
      }
    EXPECT_LE(bound, least);
    EXPECT_GE(bound, 0.9 * least);
  }
}

// Ages that nothing has are left out. So the bound rises.
TEST(LeastOverPhases, LeavesOutWhatCannotBe) {
  const Duration period = Duration::milliseconds(40), least = Duration::milliseconds(50);
  Possible possible{period, {{0.01, period, least}}, {}, {}};
  const auto bounded = [](const Round& round) { return bounded_mean_error(round, Motion::kConstantVelocity, 1.0); };
  const double free = least_over_phases(possible, bounded, 1e9, 2'000);
  const Duration later = least + Duration::milliseconds(10);
  possible.attainable = [&](const auto&, const std::vector<Duration>& oldest) { return oldest[0] >= later; };
  const double bound = least_over_phases(possible, bounded, 1e9, 2'000);
  EXPECT_NEAR(free, error_at_ages(possible, {least}, 1.0), 1e-3 * free);
  EXPECT_NEAR(bound, error_at_ages(possible, {later}, 1.0), 1e-3 * bound);
}

// Two lists that cannot both be new: their ages have a least sum. Ages may also be longer than by a period.
TEST(LeastOverPhases, IsBelowAllAgesThatCanBe) {
  RandomStream draws({23});
  for (int draw = 0; draw < 8; ++draw) {
    const Duration period = Duration::milliseconds(draws.integer(20, 60));
    Possible possible{period, {}, {}, {}};
    for (int s = 0; s < 2; ++s)
      possible.streams.push_back(
          {drawn_between(draws, 1e-3, 0.1), period, Duration::milliseconds(draws.integer(20, 90))});
    const Duration sum = possible.streams[0].least_age + possible.streams[1].least_age +
                         Duration{draws.integer(period.ns / 8, 3 * period.ns / 2)};
    possible.attainable = [&](const auto&, const std::vector<Duration>& oldest) {
      return oldest[0] + oldest[1] >= sum;
    };
    const double density = drawn_between(draws, 0.01, 30.0);
    const auto bounded = [&](const Round& round) {
      return bounded_mean_error(round, Motion::kConstantVelocity, density);
    };
    const double bound = least_over_phases(possible, bounded, 1e9, 3'000);
    double least = 1e9;
    for (int a = 0; a < 60; ++a)
      for (int b = 0; b < 60; ++b) {
        const std::vector<Duration> ages{possible.streams[0].least_age + Duration{period.ns * a / 24},
                                         possible.streams[1].least_age + Duration{period.ns * b / 24}};
        if (ages[0] + ages[1] >= sum) least = std::min(least, error_at_ages(possible, ages, density));
      }
    EXPECT_LE(bound, least) << draw;
    EXPECT_GE(bound, 0.95 * least) << draw;
  }
}

// One of three lists can be new. The two others are late.
TEST(LeastOverPhases, LetsSeveralStreamsBeLate) {
  RandomStream draws({24});
  for (int draw = 0; draw < 6; ++draw) {
    const Duration period = Duration::milliseconds(draws.integer(20, 40));
    Possible possible{period, {}, {}, {}};
    for (int s = 0; s < 3; ++s)
      possible.streams.push_back(
          {drawn_between(draws, 1e-2, 0.1), period, Duration::milliseconds(draws.integer(20, 60))});
    const std::int64_t more = draws.integer(period.ns / 2, period.ns);
    const auto can_be = [&](const std::vector<Duration>& oldest) {
      int new_ones = 0;
      for (std::size_t s = 0; s < 3; ++s)
        if (oldest[s] < possible.streams[s].least_age + Duration{more}) ++new_ones;
      return new_ones < 2;
    };
    possible.attainable = [&](const auto&, const std::vector<Duration>& oldest) { return can_be(oldest); };
    const double density = drawn_between(draws, 0.1, 30.0);
    const auto bounded = [&](const Round& round) {
      return bounded_mean_error(round, Motion::kConstantVelocity, density);
    };
    const double bound = least_over_phases(possible, bounded, 1e9, 1'500);
    double least = 1e9;
    constexpr int kCells = 8;  // of a period
    std::vector<Duration> ages(3);
    for (int cell = 0; cell < 16 * 16 * 16; ++cell) {
      for (std::size_t s = 0, rest = static_cast<std::size_t>(cell); s < 3; ++s, rest /= 16) {
        const auto at = static_cast<std::int64_t>(rest % 16);
        // The least age that is not new is tried as well.
        ages[s] = possible.streams[s].least_age + Duration{at == 15 ? more : period.ns * at / kCells};
      }
      if (can_be(ages)) least = std::min(least, error_at_ages(possible, ages, density));
    }
    EXPECT_LE(bound, least) << draw;
    EXPECT_GE(bound, 0.97 * least) << draw;
  }
}

TEST(LeastOverPhases, EndsWhenItHasEnough) {
  const Duration period = Duration::milliseconds(40);
  const Possible possible{period, {{0.01, period, period}}, {}, {}};
  int boxes = 0;
  const auto bounded = [&](const Round& round) {
    ++boxes;
    return bounded_mean_error(round, Motion::kConstantVelocity, 1.0);
  };
  EXPECT_GT(least_over_phases(possible, bounded, 1e-4, 10'000), 1e-4);
  EXPECT_LT(boxes, 100);
}

}  // namespace
}  // namespace ttf::experiments::judges
