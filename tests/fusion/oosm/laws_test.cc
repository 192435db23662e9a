// Laws L1 to L7 and L9 of fusion/oosm/method.h, for every method. L8 has separate tests.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "tests/fusion/dense.h"
#include "tests/fusion/oosm/any_methods.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::oosm {
namespace {

using Events = Timeline<2, 1>;

class OosmLaws : public testing::TestWithParam<Kind> {
 protected:
  static OnLine started() {
    OnLine method(GetParam(), Line{});
    method.start(GlobalTime{}, prior());
    return method;
  }
  static linear::Gaussian<2> prior() {
    RandomStream stream({.seed = 21});
    return drawn_prior<2>(stream);
  }
  static Events in_time(std::uint64_t seed) {
    RandomStream stream({.seed = seed});
    return drawn_timeline<2, 1>(stream, 40);
  }
  static Events out_of_sequence(std::uint64_t seed) {
    RandomStream stream({.seed = seed, .index = 1});
    return delayed<2, 1>(stream, in_time(seed), 3);
  }
};
INSTANTIATE_TEST_SUITE_P(EveryMethod, OosmLaws, every_kind(), kind_of);

TEST_P(OosmLaws, L1InOrder) {
  OnLine method = started();
  linear::Gaussian<2> expected = prior();
  GlobalTime time{};
  for (const auto& event : in_time(1)) {
    advance<2>(expected, Line{}, event.stamp.time() - time);
    correct<2, 1>(expected, event.measurement);
    time = event.stamp.time();
    ASSERT_EQ(method.take(event.stamp, event.measurement), Taken::kInOrder);
    ASSERT_TRUE(same_bits<2>(method.state(), expected));
  }
  EXPECT_LT((relative_difference<2>(expected, in_order<2, 1>(Line{}, prior(), in_time(1)))), 1e-12);
}

TEST_P(OosmLaws, L2Newest) {
  OnLine method = started();
  EXPECT_EQ(method.time(), GlobalTime{});
  Stamp newest = Stamp::start(GlobalTime{});
  int late = 0;
  for (const auto& event : out_of_sequence(2)) {
    const Taken taken = method.take(event.stamp, event.measurement);
    ASSERT_EQ(taken == Taken::kInOrder, event.stamp > newest);
    newest = std::max(newest, event.stamp);
    late += taken != Taken::kInOrder ? 1 : 0;
    ASSERT_EQ(method.time(), newest.time());
  }
  EXPECT_GT(late, 3);
}

//   too old . start . . . . . . . . . newest, again
TEST_P(OosmLaws, L3Refused) {
  OnLine plain = started(), bothered = started();
  for (const auto& event : in_time(3)) {
    plain.take(event.stamp, event.measurement);
    ASSERT_EQ(bothered.take(event.stamp, event.measurement), Taken::kInOrder);
    ASSERT_EQ(bothered.take(event.stamp, event.measurement), Taken::kDuplicate);
    ASSERT_EQ(bothered.take(stamp_at(GlobalTime{} - Duration::nanoseconds(1)), event.measurement), Taken::kTooOld);
    ASSERT_TRUE(same_bits<2>(bothered.state(), plain.state()));
    ASSERT_EQ(bothered.time(), plain.time());
  }
}

TEST_P(OosmLaws, L4Gains) {
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    OnLine method = started();
    const Events arrivals = out_of_sequence(seed);
    for (auto event = arrivals.begin(); event != arrivals.end(); ++event) {
      for (auto later = event + 1; later != arrivals.end(); ++later)
        if (later->stamp < event->stamp) method.announce(later->stamp);
      const linear::Matrix<2> before = method.state().p;
      const Taken taken = method.take(event->stamp, event->measurement);
      const linear::Matrix<2> p = method.state().p;
      ASSERT_EQ(p, p.transpose().eval());
      ASSERT_GE(least_eigenvalue(p), 0.0);
      if (taken != Taken::kLate) continue;
      ++late;
      ASSERT_GE(least_eigenvalue(before - p), -1e-12 * before.norm());
      ASSERT_LT(p.trace(), before.trace());
    }
  }
  EXPECT_GT(late, 60);
}

// Each measurement has a hundred millionth of the prior variance, so the result is a small difference of
// large numbers. The late one is from the interval before. For every other seed it has the same instant and
// measures the same component: only rounding remains.
TEST_P(OosmLaws, L4GainsOfPreciseMeasurements) {
  constexpr double kPrecise = 1e-8, kRounding = 1e-13;
  double least = 1.0, gain = 1.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    OnLine method = started();
    RandomStream stream({.seed = seed, .index = 2});
    Events events = drawn_timeline<2, 1>(stream, 12);
    auto &late = events[10], &newest = events[11];
    if (seed % 2 == 0) {
      newest.stamp = stamp_at(late.stamp.time() + Duration::milliseconds(1000), 1, 1);
      late.stamp = stamp_at(newest.stamp.time(), 0, 0);
      late.measurement.h = newest.measurement.h;
    }
    std::swap(late, newest);
    method.announce(newest.stamp);
    for (auto& event : events) {
      const linear::Matrix<2> before = method.state().p;
      const bool precise = &event == &late || &event == &newest;
      if (precise) event.measurement.r = kPrecise * event.measurement.h * before * event.measurement.h.transpose();
      const Taken taken = method.take(event.stamp, event.measurement);
      ASSERT_EQ(taken, &event == &newest ? Taken::kLate : Taken::kInOrder);
      if (taken != Taken::kLate) continue;
      const linear::Matrix<2> p = method.state().p;
      ASSERT_EQ(p, p.transpose().eval());
      least = std::min(least, least_eigenvalue(p) / before.norm());
      gain = std::min(gain, least_eigenvalue(before - p) / before.norm());
    }
  }
  EXPECT_GE(least, -kRounding);
  EXPECT_GE(gain, -kRounding);
}

TEST_P(OosmLaws, L5Value) {
  OnLine one = started();
  const Events arrivals = out_of_sequence(5);
  const std::size_t half = arrivals.size() / 2;
  for (std::size_t i = 0; i < half; ++i) one.take(arrivals[i].stamp, arrivals[i].measurement);
  OnLine other = one;
  const linear::Gaussian<2> then = one.state();
  for (std::size_t i = half; i < arrivals.size(); ++i) other.take(arrivals[i].stamp, arrivals[i].measurement);
  EXPECT_TRUE(same_bits<2>(one.state(), then));
  EXPECT_FALSE(same_bits<2>(one.state(), other.state()));
  for (std::size_t i = half; i < arrivals.size(); ++i) one.take(arrivals[i].stamp, arrivals[i].measurement);
  EXPECT_TRUE(same_bits<2>(one.state(), other.state()));
}

TEST_P(OosmLaws, L6NoHeap) {
  const Events arrivals = out_of_sequence(6);
  OnLine method = started();
  const std::int64_t before = support::allocations();
  method.start(GlobalTime{}, prior());
  for (const auto& event : arrivals) {
    method.announce(event.stamp);
    method.take(event.stamp, event.measurement);
  }
  EXPECT_EQ(support::allocations(), before);
}

TEST_P(OosmLaws, L7Start) {
  OnLine fresh = started(), used = started();
  take_all(used, out_of_sequence(7));
  used.announce(stamp_at(used.time() + Duration::milliseconds(1)));
  used.start(GlobalTime{}, prior());
  EXPECT_EQ(used.time(), GlobalTime{});
  EXPECT_TRUE(same_bits<2>(used.state(), prior()));
  EXPECT_EQ(take_all(used, out_of_sequence(8)), take_all(fresh, out_of_sequence(8)));
  EXPECT_TRUE(same_bits<2>(used.state(), fresh.state()));
}

// Sight of the next instant, of the one half-way to the newest taken, and of the newest.
TEST_P(OosmLaws, L9Sight) {
  OnLine method = started();
  Stamp newest = Stamp::start(GlobalTime{});
  int seen = 0, unseen = 0;
  for (const auto& event : out_of_sequence(9)) {
    const Stamp between = stamp_at(GlobalTime{(event.stamp.time().ns + newest.time().ns) / 2}, 3);
    for (const Stamp& stamp : {event.stamp, between, newest}) {
      const OnLine before = method;
      const std::optional<linear::Gaussian<2>> then = method.at(stamp);
      ASSERT_TRUE(same_bits<2>(method.state(), before.state()));
      OnLine would = method;
      const Taken taken = would.take(stamp, event.measurement);
      ASSERT_EQ(then.has_value(), taken == Taken::kInOrder || taken == Taken::kLate);
      seen += then ? 1 : 0;
      unseen += then ? 0 : 1;
      if (taken == Taken::kInOrder) {
        ASSERT_TRUE(same_bits<2>(*then, advanced<2>(method.state(), Line{}, stamp.time() - method.time())));
      }
    }
    method.take(event.stamp, event.measurement);
    newest = std::max(newest, event.stamp);
  }
  EXPECT_GT(seen, 40);
  EXPECT_GE(unseen, 40);
}

}  // namespace
}  // namespace ttf::fusion::oosm
