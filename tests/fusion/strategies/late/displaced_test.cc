// Law L10: a past whose anchor moved, against the joint distribution of all states and of the displacement.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "core/random.h"
#include "fusion/strategies/late/pasts.h"
#include "tests/fusion/dense.h"

namespace ttf::fusion::strategies::late {
namespace displaced {
namespace {

using oosm::Kind;

// One measured position, in the order of arrival. One displaces. Later positions are the new anchor's.
struct Seen {
  int ms;
  bool of_new = false, displaces = false;
};

constexpr double kDensity = 2.0, kSigma = 0.2, kPriorSigma[] = {0.3, 0.4, 2.0, 3.0};
const estimators::Displacement kMoved{{2.2, -0.4}, (linear::Matrix<2>() << 0.06, 0.01, 0.01, 0.02).finished()};

GlobalTime at_ms(int ms) { return GlobalTime{} + Duration::milliseconds(ms); }

linear::Matrix<4> transition(double dt) {
  linear::Matrix<4> f = linear::Matrix<4>::Identity();
  f(0, 2) = f(1, 3) = dt;
  return f;
}
linear::Matrix<4> noise(double dt) {
  linear::Matrix<4> q = linear::Matrix<4>::Zero();
  q.topLeftCorner<2, 2>().diagonal().setConstant(kDensity * dt * dt * dt / 3.0);
  q(0, 2) = q(2, 0) = q(1, 3) = q(3, 1) = kDensity * dt * dt / 2.0;
  q.bottomRightCorner<2, 2>().diagonal().setConstant(kDensity * dt);
  return q;
}

linear::Gaussian<4> prior() {
  linear::Gaussian<4> state;
  state.x << 20.0, 3.0, 7.0, -1.0;
  for (int i = 0; i < 4; ++i) state.p(i, i) = kPriorSigma[i] * kPriorSigma[i];
  return state;
}

// Returns the newest state of the new anchor, given all positions. It follows from the joint distribution.
linear::Gaussian<4> by_the_whole(const std::vector<Seen>& seen, const std::vector<linear::Vector<2>>& z) {
  const auto n = static_cast<Eigen::Index>(seen.size());
  std::vector<linear::Gaussian<4>> state(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double t = 0.001 * seen[i].ms;
    state[i].x = transition(t) * prior().x;
    state[i].p = transition(t) * prior().p * transition(t).transpose() + noise(t);
  }
  const auto covariance = [&](std::size_t i, std::size_t j) -> linear::Matrix<4> {
    if (seen[i].ms >= seen[j].ms) return transition(0.001 * (seen[i].ms - seen[j].ms)) * state[j].p;
    return state[i].p * transition(0.001 * (seen[j].ms - seen[i].ms)).transpose();
  };
  std::size_t newest = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i].ms > seen[newest].ms) newest = i;
  Eigen::MatrixXd s(2 * n, 2 * n), c(4, 2 * n);
  Eigen::VectorXd nu(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto b = static_cast<std::size_t>(j);
      s.block<2, 2>(2 * i, 2 * j) = covariance(a, b).topLeftCorner<2, 2>();
      if (seen[a].of_new && seen[b].of_new) s.block<2, 2>(2 * i, 2 * j) += kMoved.spread;
      if (i == j) s.block<2, 2>(2 * i, 2 * j) += kSigma * kSigma * linear::Matrix<2>::Identity();
    }
    c.middleCols<2>(2 * i) = covariance(newest, a).leftCols<2>();
    if (seen[a].of_new) c.block<2, 2>(0, 2 * i) += kMoved.spread;
    nu.segment<2>(2 * i) = z[a] - state[a].x.head<2>();
    if (seen[a].of_new) nu.segment<2>(2 * i) -= kMoved.by;
  }
  linear::Gaussian<4> result = state[newest];
  result.x.head<2>() += kMoved.by;
  result.p.topLeftCorner<2, 2>() += kMoved.spread;
  const Eigen::MatrixXd gain = solve(s, c.transpose()).transpose();
  result.x += gain * nu;
  result.p -= gain * c.transpose();
  return result;
}

void expect_exact(Kind kind, const std::vector<Seen>& seen) {
  SCOPED_TRACE(std::string(name_of(kind)));
  config::TrackerConfig config;
  config.process_noise = kDensity;
  config.late = kind;
  const std::unique_ptr<Pasts> pasts = make_pasts(config, 1);
  pasts->start(0, GlobalTime{}, prior());
  RandomStream draw({.seed = 31});
  const auto when = [&](const Seen& one) {
    return When{{at_ms(one.ms), {SensorId{0}, static_cast<std::uint32_t>(one.ms)}}, {}};
  };
  // Late ones only: there is room for kClones announced instants, and one too many is refused when it comes late.
  int latest = 0;
  for (const Seen& one : seen) {
    if (one.ms < latest) pasts->announce(0, when(one).stamp);
    latest = std::max(latest, one.ms);
  }
  std::vector<linear::Vector<2>> z;
  for (const Seen& one : seen) {
    const double t = 0.001 * one.ms;
    z.push_back(prior().x.head<2>() + t * prior().x.tail<2>() +
                kSigma * linear::Vector<2>(draw.normal(), draw.normal()));
    if (one.of_new) z.back() += kMoved.by + linear::Vector<2>(0.2, 0.1);
    sensors::Observation position;
    position.z.head<2>() = z.back();
    position.r.topLeftCorner<2, 2>() = kSigma * kSigma * linear::Matrix<2>::Identity();
    const oosm::Taken taken = pasts->take(0, when(one), position, one.displaces ? &kMoved : nullptr);
    ASSERT_TRUE(taken == oosm::Taken::kInOrder || taken == oosm::Taken::kLate) << one.ms << " ms";
  }
  const int newest = std::max_element(seen.begin(), seen.end(), [](auto& a, auto& b) { return a.ms < b.ms; })->ms;
  const auto state = std::get<linear::Gaussian<4>>(pasts->newest(0, at_ms(newest)));
  const linear::Gaussian<4> whole = by_the_whole(seen, z);
  EXPECT_LT((state.x - whole.x).norm(), 1e-9);
  EXPECT_LT((state.p - whole.p).norm(), 1e-9);
}

//   old  old    (old)   NEW  new              ( ) late
//   40   80      100    120  160 ms
TEST(Displaced, OneLatePositionOfTheOldAnchorIsExact) {
  for (const Kind kind : {Kind::kAugmented, Kind::kClone, Kind::kAdjoint})
    expect_exact(kind, {{40}, {80}, {120, true, true}, {160, true}, {100}});
  for (const Kind kind : {Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kA})
    expect_exact(kind, {{40}, {80}, {120, true, true}, {100}});
  for (const Kind kind : {Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kA})
    expect_exact(kind, {{40}, {120, true, true}, {160, true}, {140, true}});
}

TEST(Displaced, ManyLatePositionsOfBothAnchorsAreExact) {
  for (const Kind kind : {Kind::kAugmented, Kind::kClone})
    expect_exact(
        kind, {{40}, {80}, {120, true, true}, {160, true}, {200, true}, {140, true}, {100}, {60}, {180, true}, {20}});
}

// A late position moves its own state. It moves all later ones. Their positions stay the old anchor's.
//   old  (NEW)  old'
//   40    60     80
TEST(Displaced, ALatePositionOfTheNewAnchorIsExact) {
  for (const Kind kind : {Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kA})
    expect_exact(kind, {{40}, {80}, {60, true, true}});
  for (const Kind kind : {Kind::kAugmented, Kind::kClone})
    expect_exact(kind, {{40}, {80}, {60, true, true}, {70, true}, {30}, {50}, {120, true}});
}

}  // namespace
}  // namespace displaced
}  // namespace ttf::fusion::strategies::late
