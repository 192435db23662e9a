// Laws L8 and L9. An exact method equals the textbook's filter in order, to a relative 1e-12. Its sight of an
// earlier instant equals the textbook's smoother.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/fusion/dense.h"
#include "tests/fusion/oosm/any_methods.h"

namespace ttf::fusion::oosm {
namespace {

constexpr double kExact = 1e-12;

template <class X, class Model>
void expect_exact(Kind kind, RandomStream& stream, const Timeline<X::kStates, X::kDimension>& arrivals, int late) {
  constexpr int kN = X::kStates, kM = X::kDimension;
  const Model motion{2.0};
  const linear::Gaussian<kN> prior = drawn_prior<kN>(stream);
  X method(kind, motion);
  method.start(GlobalTime{}, prior);
  const std::vector<Taken> taken = take_all(method, arrivals);
  EXPECT_EQ(std::count(taken.begin(), taken.end(), Taken::kLate), late);
  EXPECT_EQ(std::count(taken.begin(), taken.end(), Taken::kInOrder), std::ssize(arrivals) - late);
  EXPECT_LT((relative_difference<kN>(method.state(), in_order<kN, kM>(motion, prior, arrivals))), kExact);
}

template <int N, int M> int late_ones(const Timeline<N, M>& arrivals) {
  Stamp newest = Stamp::start(GlobalTime{});
  int late = 0;
  for (const auto& event : arrivals) {
    if (event.stamp < newest) ++late;
    newest = std::max(newest, event.stamp);
  }
  return late;
}

// 60 measurements, each up to 20 late: several are late at a time, and out of order among themselves.
template <class X, class Model> void expect_exact_in_any_order(Kind kind) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream stream({.seed = seed});
    const auto events = drawn_timeline<X::kStates, X::kDimension>(stream, 60);
    const auto arrivals = delayed(stream, events, 20);
    EXPECT_GT(late_ones(arrivals), 30);
    expect_exact<X, Model>(kind, stream, arrivals, late_ones(arrivals));
  }
}

// All of 30, the last but `lag` last.
template <class X, class Model> void expect_exact_with_one_late(Kind kind) {
  for (int lag = 1; lag <= 20; ++lag) {
    RandomStream stream({.seed = 7, .index = static_cast<std::uint32_t>(lag)});
    const auto events = drawn_timeline<X::kStates, X::kDimension>(stream, 30);
    expect_exact<X, Model>(kind, stream, one_late(events, lag), 1);
  }
}

// 1 0 3 2 5 4 ...
template <class X, class Model> void expect_exact_with_every_other_late(Kind kind) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream stream({.seed = seed});
    auto events = drawn_timeline<X::kStates, X::kDimension>(stream, 40);
    for (std::size_t i = 0; i < 40; i += 2) std::swap(events[i], events[i + 1]);
    expect_exact<X, Model>(kind, stream, events, 20);
  }
}

class ExactInAnyOrder : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Method, ExactInAnyOrder, testing::Values(Kind::kRewind, Kind::kAugmented, Kind::kClone),
                         kind_of);
TEST_P(ExactInAnyOrder, OnALine) { expect_exact_in_any_order<OnLine, Line>(GetParam()); }
TEST_P(ExactInAnyOrder, OnAPlane) { expect_exact_in_any_order<OnPlane, Plane>(GetParam()); }

class ExactWithOneLate : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Method, ExactWithOneLate,
                         testing::Values(Kind::kRewind, Kind::kAugmented, Kind::kClone, Kind::kAdjoint), kind_of);
TEST_P(ExactWithOneLate, OfUpToTwentyLagsOnALine) { expect_exact_with_one_late<OnLine, Line>(GetParam()); }
TEST_P(ExactWithOneLate, OfUpToTwentyLagsOnAPlane) { expect_exact_with_one_late<OnPlane, Plane>(GetParam()); }

// Al1 is Algorithm A here.
class ExactAtOneLag : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Method, ExactAtOneLag, testing::Values(Kind::kA, Kind::kAl1, Kind::kAdjoint), kind_of);
TEST_P(ExactAtOneLag, EveryOtherLateOnALine) { expect_exact_with_every_other_late<OnLine, Line>(GetParam()); }
TEST_P(ExactAtOneLag, EveryOtherLateOnAPlane) { expect_exact_with_every_other_late<OnPlane, Plane>(GetParam()); }

// x(tau) given all of `events` (Rauch, Tung, Striebel 1965). They are in order; tau is the instant of no
// event.
template <int N, int M, Motion<N> Model>
linear::Gaussian<N> smoothed(const Model& motion, const linear::Gaussian<N>& prior, const Timeline<N, M>& events,
                             GlobalTime tau) {
  struct Node {
    linear::Gaussian<N> predicted, filtered;
    linear::Matrix<N> f = linear::Matrix<N>::Identity();
  };
  std::vector<Node> nodes;
  std::size_t of_tau = 0;
  linear::Gaussian<N> state = prior;
  GlobalTime time{};
  const auto reach = [&](GlobalTime to) {
    Node node;
    if (to > time) node.f = motion.step((to - time).seconds()).f;
    advance<N>(state, motion, to - time);
    time = to;
    node.predicted = node.filtered = state;
    nodes.push_back(node);
  };
  for (const auto& event : events) {
    if (time < tau && tau < event.stamp.time()) {
      of_tau = nodes.size();
      reach(tau);
    }
    reach(event.stamp.time());
    update<N, M>(state, event.measurement);
    nodes.back().filtered = state;
  }
  for (std::size_t i = nodes.size() - 1; i-- > of_tau;) {
    Node &here = nodes[i], &next = nodes[i + 1];
    const linear::Matrix<N> gain = solve(next.predicted.p, next.f * here.filtered.p).transpose();
    here.filtered.x += gain * (next.filtered.x - next.predicted.x);
    here.filtered.p += gain * (next.filtered.p - next.predicted.p) * gain.transpose();
  }
  return nodes[of_tau].filtered;
}

class SeesWhatASmootherSees : public testing::TestWithParam<std::tuple<Kind, int>> {};
INSTANTIATE_TEST_SUITE_P(AtAnyLag, SeesWhatASmootherSees,
                         testing::Combine(testing::Values(Kind::kAugmented, Kind::kClone, Kind::kAdjoint),
                                          testing::Values(1, 2, 5, 15)));
INSTANTIATE_TEST_SUITE_P(AtOneLag, SeesWhatASmootherSees,
                         testing::Combine(testing::Values(Kind::kA, Kind::kAl1), testing::Values(1)));
TEST_P(SeesWhatASmootherSees, OfALateInstant) {
  const auto [kind, lag] = GetParam();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream stream({.seed = seed, .index = 5});
    Timeline<4, 2> events = drawn_timeline<4, 2>(stream, 20);
    for (std::size_t i = 0; i < events.size(); ++i)  // at separate instants
      events[i].stamp = stamp_at(events[i].stamp.time() + Duration::milliseconds(static_cast<std::int64_t>(i) + 1));
    const auto last = events.end() - lag;
    const Stamp late = stamp_at(GlobalTime{((last - 1)->stamp.time().ns + last->stamp.time().ns) / 2}, 1);
    const linear::Gaussian<4> prior = drawn_prior<4>(stream);
    OnPlane method(kind, Plane{2.0});
    method.start(GlobalTime{}, prior);
    method.announce(late);
    for (const auto& event : events) method.take(event.stamp, event.measurement);
    const std::optional<linear::Gaussian<4>> then = method.at(late);
    ASSERT_TRUE(then.has_value());
    EXPECT_LT((relative_difference<4>(*then, smoothed<4, 2>(Plane{2.0}, prior, events, late.time()))), 1e-8)
        << "the smoother divides by what is nearly singular over a millisecond";
  }
}

// Without process noise, an approximation that ignores it is exact.
class ExactWithoutNoise : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Method, ExactWithoutNoise, testing::Values(Kind::kB, Kind::kC, Kind::kBl1, Kind::kAugmented),
                         kind_of);
TEST_P(ExactWithoutNoise, EveryOtherLate) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream stream({.seed = seed});
    auto events = drawn_timeline<2, 1>(stream, 20);
    for (std::size_t i = 0; i < 20; i += 2) std::swap(events[i], events[i + 1]);
    const linear::Gaussian<2> prior = drawn_prior<2>(stream);
    OnLine method(GetParam(), Line{0.0});
    method.start(GlobalTime{}, prior);
    take_all(method, events);
    EXPECT_LT((relative_difference<2>(method.state(), in_order<2, 1>(Line{0.0}, prior, events))), 1e-11);
  }
}

}  // namespace
}  // namespace ttf::fusion::oosm
