// Every strategy, motion model, filter and late method states its errors truly. Over 1,000 drives each, NEES
// and NIS lie in their bands. Drives are drawn from the model that the tracker assumes, with late and
// unordered lists of two sensors. With a thirtieth of the noise assumed, they lie outside (Bar-Shalom, Li,
// Kirubarajan 2001, section 5.4). A thousand drives cannot distinguish the approximate methods from exact
// ones.
//
// Each drive is judged once, at its end, so that the sums are chi-square distributed. All figures of one kind
// lie in their bands together with a probability of 95 %. Single bands are widened accordingly.
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "fusion/metrics/consistency.h"
#include "fusion/motion/constant_acceleration.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/motion/ctra.h"
#include "fusion/motion/ctrv.h"
#include "fusion/oosm/kind.h"
#include "tests/fusion/drives.h"
#include "tests/fusion/motion/drawn.h"

namespace ttf::fusion::oosm {
namespace {

using metrics::Consistency;

constexpr std::uint32_t kDrives = 1000, kLists = 80;
constexpr std::int64_t kEvery = 50, kLatest = 130;  // [ms] from list to list; until its arrival
constexpr double kSigma = 0.2;                      // [m] of a position, per axis
constexpr double kAlong = 0.5, kTurn = 0.05;        // the densities that drives are drawn with
constexpr double kWrong = 1.0 / 30.0;

struct Case {
  std::string name;
  strategies::StrategyKind strategy = strategies::StrategyKind::kAdva;
  config::MotionModel motion = config::MotionModel::kConstantVelocity;
  config::FilterKind filter = config::FilterKind::kExtended;
  oosm::Kind late = oosm::Kind::kRewind;
};

config::TrackerConfig config_for(const Case& c, double noise_times) {
  config::TrackerConfig config = config_of(c.motion, kAlong * noise_times, c.filter);
  config.turn_noise = kTurn * noise_times;
  config.initial_turn_rate_sigma = 0.5;
  config.confirm_hits = config.confirm_window = 1;
  config.gate_probability = 0.999999;  // one object, no clutter
  config.late = c.late;
  return config;
}

// Each of two sensors every 100 ms, in turn; on a schedule where strategy or method needs one.
std::vector<strategies::SensorTiming> sensors(const Case& c) {
  const bool known = c.strategy == strategies::StrategyKind::kTt || c.late == oosm::Kind::kClone;
  std::vector<strategies::SensorTiming> both;
  for (std::uint8_t s = 0; s < 2; ++s)
    both.push_back(known ? scheduled(s, kLatest, s * kEvery, 2 * kEvery) : free_running(s, kLatest));
  return both;
}

struct Judged {
  Consistency nees, nis;
  int lost = 0;
};

template <class M>
void judge_one(const Case& c, const M& truth, linear::Vector<M::kStates> x, double noise_times, std::uint32_t drive,
               Judged& judged) {
  RandomStream stream({.seed = 11, .replication = drive});
  const auto seen = [&] {
    const motion::Kinematics at = M::template kinematics<motion::kWithVelocity>(x);
    return position(at.position.x() + kSigma * stream.normal(), at.position.y() + kSigma * stream.normal(), kSigma);
  };
  std::vector<Arrival> arrivals;
  motion::Kinematics last;
  for (std::uint32_t k = 0; k < kLists; ++k) {
    if (k > 0) x = motion::drawn<M::kStates>(truth.move(x, 1e-3 * kEvery), truth.noise(x, 1e-3 * kEvery), stream);
    last = M::template kinematics<motion::kWithVelocity>(x);
    const std::int64_t at = kEvery * k;
    // The first lists are in time, so that all methods start with a track.
    const std::int64_t delay = k < 4 ? 0 : stream.integer(0, kLatest - 10);
    arrivals.push_back({at + delay, list_of(static_cast<std::uint8_t>(k % 2), k / 2, at_ms(at), {seen()})});
  }
  sort_by_arrival(arrivals);
  const auto strategy = make_strategy(c.strategy, config_for(c, noise_times), sensors(c));
  run(*strategy, arrivals, kEvery * kLists + 300);
  std::vector<tracks::TrackView> image;
  strategy->image(at_ms(kEvery * kLists), image);
  if (strategy->tracks().size() != 1 || image.size() != 1) {
    ++judged.lost;
    return;
  }
  const tracks::TrackView& track = strategy->tracks()[0];
  linear::Vector<4> error = track.state.head<4>();
  error.head<2>() -= last.position;
  error.tail<2>() -= last.velocity;
  judged.nees.add(metrics::normalised_squared<4>(error, track.covariance.topLeftCorner<4, 4>()), 4);
  x = motion::drawn<M::kStates>(truth.move(x, 1e-3 * kEvery), truth.noise(x, 1e-3 * kEvery), stream);
  const sensors::Observation next = seen();
  const linear::Vector<2> innovation = next.z.head<2>() - image[0].state.head<2>();
  const linear::Matrix<2> spread = image[0].covariance.topLeftCorner<2, 2>() + next.r.topLeftCorner<2, 2>();
  judged.nis.add(metrics::normalised_squared<2>(innovation, spread), 2);
}

Judged judge(const Case& c, double noise_times, std::uint32_t drives) {
  Judged judged;
  for (std::uint32_t drive = 0; drive < drives; ++drive) {
    const auto from = [&](const auto& truth, auto start) { judge_one(c, truth, start, noise_times, drive, judged); };
    switch (c.motion) {
      case config::MotionModel::kConstantVelocity:
        from(motion::ConstantVelocity(kAlong), linear::Vector<4>(40.0, 0.0, 5.4, 8.4));
        break;
      case config::MotionModel::kConstantAcceleration:
        from(motion::ConstantAcceleration(kAlong), linear::Vector<6>(40.0, 0.0, 5.4, 8.4, 0.5, -0.5));
        break;
      case config::MotionModel::kCtrv:
        from(motion::Ctrv(kTurn, kAlong), linear::Vector<5>(40.0, 0.0, 1.0, 10.0, 0.5));
        break;
      case config::MotionModel::kCtra:
        from(motion::Ctra(kTurn, kAlong), linear::Vector<6>(40.0, 0.0, 1.0, 6.0, 0.5, 1.0));
        break;
      case config::MotionModel::kInteracting: break;  // no drive is drawn from it: motion_choice_test.cc
    }
  }
  return judged;
}

std::vector<Case> every_case() {
  std::vector<Case> all;
  const std::pair<config::MotionModel, std::string> motions[] = {
      {config::MotionModel::kConstantVelocity, "constant_velocity"},
      {config::MotionModel::kConstantAcceleration, "constant_acceleration"},
      {config::MotionModel::kCtrv, "ctrv"},
      {config::MotionModel::kCtra, "ctra"}};
  for (const auto& [how, strategy] : strategies::kStrategyNames)
    for (const auto& [motion, model] : motions)
      for (const config::FilterKind filter : {config::FilterKind::kExtended, config::FilterKind::kUnscented}) {
        all.push_back(
            {std::string(how) + " " + model + (filter == config::FilterKind::kExtended ? " extended" : " unscented"),
             strategy, motion, filter, oosm::Kind::kRewind});
        const bool straight =
            motion == config::MotionModel::kConstantVelocity || motion == config::MotionModel::kConstantAcceleration;
        if (filter != config::FilterKind::kExtended || !straight || strategy == strategies::StrategyKind::kBuff)
          continue;
        for (const oosm::NamedKind& method : oosm::kKinds)
          if (method.kind != oosm::Kind::kRewind &&
              (strategy == strategies::StrategyKind::kAdva || method.kind == oosm::Kind::kClone))
            all.push_back({std::string(how) + " " + model + " " + std::string(method.name), strategy, motion, filter,
                           method.kind});
      }
  return all;
}

TEST(ThousandDrives, EveryCombinationIsConsistent) {
  const std::vector<Case> all = every_case();
  const double tail = 0.025 / static_cast<double>(all.size());
  for (const Case& c : all) {
    const Judged judged = judge(c, 1.0, kDrives);
    std::cout << c.name << ": nees " << judged.nees.mean() << " of 4, nis " << judged.nis.mean() << " of 2, lost "
              << judged.lost << "\n";
    EXPECT_LE(judged.lost, 1) << c.name << ": a position in a million is outside of its gate, and 80 are in a drive";
    EXPECT_TRUE(judged.nees.consistent(tail)) << c.name << ": " << judged.nees.mean();
    EXPECT_TRUE(judged.nis.consistent(tail)) << c.name << ": " << judged.nis.mean();
  }
}

TEST(ThousandDrives, AWrongModelShowsInEveryCombination) {
  for (const Case& c : every_case()) {
    const Judged judged = judge(c, kWrong, 200);
    EXPECT_GT(judged.nees.mean(), judged.nees.band(1e-4).high) << c.name;
    std::cout << c.name << ": nees " << judged.nees.mean() << " of 4, nis " << judged.nis.mean() << " of 2\n";
  }
}

}  // namespace
}  // namespace ttf::fusion::oosm
