// The tracker under each motion model and filter. A model gains accuracy where it is right and states its
// errors truly. Orders of arrival and memory are handled the same by all.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include "fusion/metrics/chi_square.h"
#include "fusion/motion/ctra.h"
#include "fusion/motion/ctrv.h"
#include "fusion/tracks/timeline.h"
#include "tests/fusion/choices.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/drives.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/fusion/scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::estimators {
namespace {

constexpr int kRuns = 300, kSteps = 100;
constexpr double kDt = 0.05, kSigma = 0.2;
constexpr double kAlong = 0.5, kTurn = 0.05;  // densities of the drawn drives

config::TrackerConfig alone(config::MotionModel motion, double process_noise, config::FilterKind filter) {
  config::TrackerConfig config = config_of(motion, process_noise, filter);
  config.turn_noise = kTurn;
  config.initial_turn_rate_sigma = 0.5;
  config.confirm_hits = config.confirm_window = 1;
  config.gate_probability = 0.999999;  // one object, no clutter
  return config;
}

// One object drives as `truth` says, from `start`; its position is seen every 50 ms. The NEES takes the error
// of (x, y, vx, vy) at each run's last instant. Root mean squares cover the second half.
struct Judged {
  double nees = 0.0, position = 0.0, velocity = 0.0;
  int lost = 0;
  static double lower() { return metrics::chi_square_quantile(1e-4, 4.0 * kRuns) / kRuns; }
  static double upper() { return metrics::chi_square_quantile(1.0 - 1e-4, 4.0 * kRuns) / kRuns; }
};

template <class M>
Judged judge(const config::TrackerConfig& config, const M& truth, const linear::Vector<M::kStates>& start) {
  Judged judged;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream stream({.seed = 31, .replication = static_cast<std::uint32_t>(run)});
    tracks::Tracker tracker(config, 1);
    tracks::TrackSet set(tracker.max_tracks());
    linear::Vector<M::kStates> x = start;
    for (int k = 0; k < kSteps; ++k) {
      x = motion::drawn<M::kStates>(truth.move(x, kDt), truth.noise(x, kDt), stream);
      tracker.step(set, list_of(0, static_cast<std::uint32_t>(k), at_ms(50 * k),
                                {position(x(0) + kSigma * stream.normal(), x(1) + kSigma * stream.normal(), kSigma)})
                            .view());
      judged.lost += set.tracks.size() != 1;
      if (k < kSteps / 2 || set.tracks.empty()) continue;
      const Cartesian seen = tracker.estimator().cartesian(set.tracks[0].estimate);
      const motion::Kinematics there = M::template kinematics<motion::kWithVelocity>(x);
      linear::Vector<4> error;
      error << seen.x.head<2>() - there.position, seen.x.segment<2>(2) - there.velocity;
      judged.position += error.head<2>().squaredNorm() / (kRuns * kSteps / 2);
      judged.velocity += error.tail<2>().squaredNorm() / (kRuns * kSteps / 2);
      const linear::Matrix<4> p = seen.p.topLeftCorner<4, 4>();
      if (k + 1 == kSteps) judged.nees += norm_squared(error, p) / kRuns;
    }
  }
  judged.position = std::sqrt(judged.position);
  judged.velocity = std::sqrt(judged.velocity);
  return judged;
}

Judged on_a_bend(config::MotionModel motion, double process_noise, config::FilterKind filter) {
  linear::Vector<5> start;
  start << 40.0, 0.0, 1.0, 10.0, 0.5;
  return judge(alone(motion, process_noise, filter), motion::Ctrv(kTurn, kAlong), start);
}
Judged on_a_bend_faster_and_faster(config::MotionModel motion, double process_noise, config::FilterKind filter) {
  linear::Vector<6> start;
  start << 40.0, 0.0, 1.0, 4.0, 0.5, 2.5;
  return judge(alone(motion, process_noise, filter), motion::Ctra(kTurn, kAlong), start);
}

// The covariance is true, and the error is smaller than constant velocity's, with any noise for a bend.
template <class Straight> void expect_right(const Judged& right, const Straight& straight_with) {
  EXPECT_EQ(right.lost, 0);
  EXPECT_GT(right.nees, Judged::lower());
  EXPECT_LT(right.nees, Judged::upper());
  for (const double q : {0.5, 3.0, 10.0, 30.0, 100.0}) {
    const Judged straight = straight_with(q);
    std::cout << "cv " << q << ": nees " << straight.nees << ", " << straight.position << " m, " << straight.velocity
              << " m/s, lost " << straight.lost << "\n";
    EXPECT_LT(right.position, 0.85 * straight.position) << q;
    EXPECT_LT(right.velocity, 0.75 * straight.velocity) << q;
    if (q <= 3.0) {
      EXPECT_GT(straight.nees, Judged::upper()) << q;
    }
  }
}

class OnABend : public testing::TestWithParam<config::FilterKind> {};
INSTANTIATE_TEST_SUITE_P(Filter, OnABend,
                         testing::Values(config::FilterKind::kExtended, config::FilterKind::kUnscented),
                         [](const auto& filter) {
                           return filter.param == config::FilterKind::kExtended ? "Extended" : "Unscented";
                         });

TEST_P(OnABend, CtrvIsRight) {
  const Judged right = on_a_bend(config::MotionModel::kCtrv, kAlong, GetParam());
  std::cout << "ctrv: nees " << right.nees << ", " << right.position << " m, " << right.velocity << " m/s\n";
  expect_right(right, [](double q) { return on_a_bend(config::MotionModel::kConstantVelocity, q, GetParam()); });
}

TEST_P(OnABend, CtraIsRightWithAccelerationToo) {
  const Judged right = on_a_bend_faster_and_faster(config::MotionModel::kCtra, kAlong, GetParam());
  std::cout << "ctra: nees " << right.nees << ", " << right.position << " m, " << right.velocity << " m/s\n";
  expect_right(right, [](double q) {
    return on_a_bend_faster_and_faster(config::MotionModel::kConstantVelocity, q, GetParam());
  });
  const Judged constant_speed = on_a_bend_faster_and_faster(config::MotionModel::kCtrv, kAlong, GetParam());
  std::cout << "ctrv: nees " << constant_speed.nees << ", " << constant_speed.position << " m\n";
  EXPECT_GT(constant_speed.nees, Judged::upper()) << "it accelerates";
}

// Five seconds straight on, then five of bend: either model alone is worse in one part.
struct Legs {
  double straight = 0.0, bend = 0.0;  // root mean squares of the velocity's error
};
Legs on_two_legs(config::MotionModel motion, config::FilterKind filter) {
  Legs legs;
  const motion::Ctrv way(1e-9, 1e-9);
  for (std::uint32_t run = 0; run < 30; ++run) {
    RandomStream stream({.seed = 32, .replication = run});
    config::TrackerConfig config = alone(motion, 0.1, filter);
    config.turn_noise = 0.2;
    tracks::Tracker tracker(config, 1);
    tracks::TrackSet set(tracker.max_tracks());
    linear::Vector<5> x;
    x << 40.0, 0.0, 1.0, 10.0, 0.0;
    for (int k = 0; k < 200; ++k) {
      x(4) = k < 100 ? 0.0 : 0.5;
      x = way.move(x, kDt);
      tracker.step(set, list_of(0, static_cast<std::uint32_t>(k), at_ms(50 * k),
                                {position(x(0) + kSigma * stream.normal(), x(1) + kSigma * stream.normal(), kSigma)})
                            .view());
      if (k % 100 < 50 || set.tracks.empty()) continue;
      const Cartesian seen = tracker.estimator().cartesian(set.tracks[0].estimate);
      const linear::Vector<2> velocity = motion::Ctrv::kinematics<motion::kWithVelocity>(x).velocity;
      (k < 100 ? legs.straight : legs.bend) += (seen.x.segment<2>(2) - velocity).squaredNorm() / 1500.0;
    }
  }
  return {std::sqrt(legs.straight), std::sqrt(legs.bend)};
}

TEST_P(OnABend, InteractingModelsTakeTheBetterOne) {
  const Legs cv = on_two_legs(config::MotionModel::kConstantVelocity, GetParam()),
             ctrv = on_two_legs(config::MotionModel::kCtrv, GetParam()),
             both = on_two_legs(config::MotionModel::kInteracting, GetParam());
  std::cout << "straight, bend [m/s]: cv " << cv.straight << " " << cv.bend << ", ctrv " << ctrv.straight << " "
            << ctrv.bend << ", both " << both.straight << " " << both.bend << "\n";
  EXPECT_LT(both.straight, 0.5 * ctrv.straight);
  EXPECT_LT(both.bend, 0.3 * cv.bend);
}

class EveryChoice : public testing::TestWithParam<Choice> {
 protected:
  config::TrackerConfig config = config_of(std::get<0>(GetParam()), 3.0, std::get<1>(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(All, EveryChoice, every_choice(), name_of_choice);

// Two cars, one turning, seen by a laser and a radar; three lists share an instant.
std::vector<OwnedList> lists_of_two_cars(std::uint32_t count) {
  RandomStream stream({.seed = 33});
  std::vector<OwnedList> lists;
  const motion::Ctrv way(1e-9, 1e-9);
  linear::Vector<5> cars[2];
  cars[0] << 30.0, 5.0, 0.2, 12.0, 0.6;
  cars[1] << 25.0, -6.0, 3.0, 8.0, 0.0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const bool tie = k % 7 == 2 || k % 7 == 3;  // at the instant of the one before
    std::vector<sensors::Observation> seen;
    for (linear::Vector<5>& car : cars) {
      if (!tie) car = way.move(car, 0.05);
      const linear::Vector<2> velocity = motion::Ctrv::kinematics<motion::kWithVelocity>(car).velocity,
                              at = car.head<2>();
      if (k % 3 == 1)
        seen.push_back(radar(at.norm() + 0.2 * stream.normal(), std::atan2(at(1), at(0)) + 0.01 * stream.normal(),
                             at.dot(velocity) / at.norm() + 0.2 * stream.normal(), 0.2, 0.01, 0.2));
      else
        seen.push_back(position(at(0) + 0.1 * stream.normal(), at(1) + 0.1 * stream.normal(), 0.1));
    }
    const GlobalTime last = lists.empty() ? at_ms(-50) : lists.back().measured;
    lists.push_back(list_of(0, k, tie ? last : last + Duration::milliseconds(50), std::move(seen)));
  }
  return lists;
}

void expect_the_same_in_every_order(const config::TrackerConfig& config, const std::vector<OwnedList>& lists,
                                    const std::vector<std::size_t>& order, const tracks::TrackSet& in_order) {
  tracks::Timeline timeline(config, 4);
  for (const std::size_t s : order) timeline.insert(lists[s].view());
  ASSERT_TRUE(same_bits(timeline.current(), in_order));
}

TEST_P(EveryChoice, AnyOrderOfArrivalGivesTheSameBits) {
  const std::vector<OwnedList> lists = lists_of_two_cars(60);
  tracks::Timeline in_order(config, 4);
  for (const OwnedList& s : lists) in_order.insert(s.view());
  ASSERT_EQ(in_order.current().tracks.size(), 2u);
  if (config.motion == config::MotionModel::kInteracting) {
    EXPECT_TRUE(std::holds_alternative<StraightOrTurning>(in_order.current().tracks[0].estimate));
  }
  std::vector<std::size_t> order(lists.size());
  std::iota(order.begin(), order.end(), 0u);
  RandomStream stream({.seed = 34});
  for (int draw = 0; draw < 20; ++draw) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i) - 1))]);
    expect_the_same_in_every_order(config, lists, order, in_order.current());
  }
}

// All 5,040 orders of the seven lists around the birth of the polar state.
TEST(MotionChoice, EveryOrderOfSevenListsUnderCtrvUnscented) {
  const config::TrackerConfig config = config_of(config::MotionModel::kCtrv, 3.0, config::FilterKind::kUnscented);
  const std::vector<OwnedList> all = lists_of_two_cars(14);
  std::vector<OwnedList> lists;
  for (std::size_t i = 0; i < all.size(); i += 2) lists.push_back(all[i]);
  tracks::Timeline in_order(config, 4);
  std::size_t young = 0, polar = 0;
  for (const OwnedList& s : lists) {
    in_order.insert(s.view());
    for (const tracks::Track& track : in_order.current().tracks) ++(track.estimate.index() == 0 ? young : polar);
  }
  ASSERT_GT(young, 2u);
  ASSERT_GT(polar, 2u);
  std::vector<std::size_t> order(lists.size());
  std::iota(order.begin(), order.end(), 0u);
  do {
    expect_the_same_in_every_order(config, lists, order, in_order.current());
    if (HasFatalFailure()) return;
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_P(EveryChoice, AllocatesNothingAfterConstruction) {
  std::vector<Arrival> arrivals = drawn_drive(9, 30);
  sort_by_arrival(arrivals);
  const auto strategy = make_strategy(strategies::StrategyKind::kAdva, config, laser_and_camera());
  std::vector<tracks::TrackView> image;
  image.reserve(64);
  const std::int64_t before = support::allocations();
  for (const Arrival& arrival : arrivals) {
    strategy->accept(arrival.list.view());
    strategy->fuse(at_ms(arrival.ms));
    strategy->image(at_ms(arrival.ms + 40), image);
  }
  EXPECT_EQ(support::allocations() - before, 0);
  EXPECT_EQ(image.size(), 25u);
}

}  // namespace
}  // namespace ttf::fusion::estimators
