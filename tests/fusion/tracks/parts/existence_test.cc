// Existence against the recursion by hand, and birth and death by it.
#include "fusion/tracks/parts/existence.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "fusion/tracks/tracker.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

config::TrackerConfig by_existence(config::Association association) {
  config::TrackerConfig config;
  config.association = association;
  config.birth = config::Birth::kExistence;
  config.detection_probability = 0.8;
  config.clutter_density = 0.01;
  config.initial_existence = 0.3;
  config.survival_seconds = 10.0;
  return config;
}

class EveryAssociation : public testing::TestWithParam<config::Association> {};
INSTANTIATE_TEST_SUITE_P(All, EveryAssociation,
                         testing::Values(config::Association::kNearest, config::Association::kJpda),
                         [](const testing::TestParamInfo<config::Association>& kind) {
                           return kind.param == config::Association::kNearest ? "Nearest" : "Jpda";
                         });

// One track, at most one observation a list, an independent filter for the density. For both associations:
//   e <- e exp(-dt/tau);  L = 1 - P_D P_G + P_D f / lambda;  e <- L e / (1 - e + L e).
TEST_P(EveryAssociation, ExistenceFollowsTheClosedForm) {
  config::TrackerConfig config = by_existence(GetParam());
  config.delete_existence = 1e-8;
  Tracker tracker(config, 4);
  TrackSet set(tracker.max_tracks());
  RandomStream stream({.seed = 1});
  const double dt = 0.05, p_d = 0.8, p_g = config.gate_probability, sigma = 0.2;
  const std::string pattern = "hhh-hh--h-----h---hhh";
  linear::Gaussian<4> by_hand;
  const linear::Matrix<4> f = transition(config.motion, dt).topLeftCorner<4, 4>();
  const linear::Matrix<4> q = driving_noise(config.motion, config.process_noise, dt).topLeftCorner<4, 4>();
  double existence = 0.0;
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    std::vector<sensors::Observation> list;
    const bool hit = pattern[k] == 'h';
    if (hit) list.push_back(position(20.0 + sigma * stream.normal(), 3.0 + sigma * stream.normal(), sigma));
    tracker.step(set, list_of(0, static_cast<std::uint32_t>(k), at_ms(50 * static_cast<std::int64_t>(k)), list).view());
    if (k == 0) {
      existence = 0.3;
      by_hand.x << list[0].z(0), list[0].z(1), 0.0, 0.0;
      by_hand.p.diagonal() << sigma * sigma, sigma * sigma, 64.0, 64.0;
    } else {
      existence *= std::exp(-dt / 10.0);
      by_hand.x = f * by_hand.x;
      by_hand.p = f * by_hand.p * f.transpose() + q;
      double likelihood = 1.0 - p_d * p_g;
      if (hit) {
        const linear::Matrix<2> s = by_hand.p.topLeftCorner<2, 2>() + sigma * sigma * linear::Matrix<2>::Identity();
        const linear::Vector<2> nu = list[0].z.head<2>() - by_hand.x.head<2>();
        const linear::Matrix<2> s_inverse = inverse(s);
        const double determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
        const double density = std::exp(-0.5 * nu.dot(s_inverse * nu)) / (2.0 * kPi * std::sqrt(determinant));
        const double ratio = p_d * density / 0.01;
        likelihood += ratio;
        // The estimate takes in all of it, or weighs it with its probability given that the object exists.
        const double beta = GetParam() == config::Association::kNearest ? 1.0 : ratio / (1.0 - p_d * p_g + ratio);
        const linear::Matrix<4, 2> gain = by_hand.p.leftCols<2>() * s_inverse;
        const linear::Vector<4> moved = gain * nu;
        by_hand.x += beta * moved;
        by_hand.p += beta * ((1.0 - beta) * moved * moved.transpose() - gain * s * gain.transpose());
      }
      existence = likelihood * existence / (1.0 - existence + likelihood * existence);
    }
    ASSERT_EQ(set.tracks.size(), 1u) << k;
    ASSERT_NEAR(set.tracks[0].existence, existence, 1e-9 * existence) << k;
    ASSERT_LT((state_of(set.tracks[0]).head<4>() - by_hand.x).norm(), 1e-9) << k;
  }
  EXPECT_GT(existence, 0.9);
}

// Two tracks share an observation: by hand, the four events of JIPDA.
TEST(Existence, OfTwoTracksThatShareAnObservation) {
  const config::TrackerConfig config = by_existence(config::Association::kJpda);
  const double gated = seen_in_gate(config), e1 = 0.7, e2 = 0.4, r1 = 5.0, r2 = 2.0;
  // Unnormalised: no observation, of the first, of the second.
  const double none = (1.0 - gated * e1) * (1.0 - gated * e2), first = e1 * r1 * (1.0 - gated * e2),
               second = (1.0 - gated * e1) * e2 * r2, all = none + first + second;
  association::JointAssociation joint(1, 2);
  const association::Pair pairs[] = {{0, 0, joint_weight(e1, r1, config)}, {0, 1, joint_weight(e2, r2, config)}};
  joint.solve(pairs, 1, 2);
  EXPECT_NEAR(joint.of_column(0)[0].probability, first / all, 1e-15);
  EXPECT_NEAR(joint.of_column(1)[0].probability, second / all, 1e-15);
  const double exists = joint.of_column(0)[0].probability + joint.none_of_column(0) * exists_unseen(e1, config);
  const double by_hand = (first + (none + second) * e1 * (1.0 - gated) / (1.0 - gated * e1)) / all;
  EXPECT_NEAR(exists, by_hand, 1e-15);
  // Alone, the joint form is the single track's.
  const association::Pair lone[] = {{0, 0, joint_weight(e1, r1, config)}};
  joint.solve(lone, 1, 1);
  EXPECT_NEAR(joint.of_column(0)[0].probability + joint.none_of_column(0) * exists_unseen(e1, config),
              after_list(e1, r1, config), 1e-15);
}

// The visibility is a factor of the detection probability, in the single form and in the joint one.
TEST(Existence, AListOfASensorThatSeesLittleSaysLittle) {
  const config::TrackerConfig config = by_existence(config::Association::kJpda);
  EXPECT_EQ(after_list(0.4, 0.0, config, 0.0), 0.4) << "nothing could have been seen";
  EXPECT_EQ(exists_unseen(0.4, config, 0.0), 0.4);
  config::TrackerConfig half = config;
  half.detection_probability = 0.5 * config.detection_probability;
  EXPECT_NEAR(after_list(0.4, 0.0, config, 0.5), after_list(0.4, 0.0, half), 1e-15);
  const sensors::Observation z = position(30.0, 2.0, 0.1);
  EXPECT_NEAR(likelihood_ratio(z, 0.3, config, 0.5), likelihood_ratio(z, 0.3, half), 1e-15);
  for (const double visible : {0.0, 0.01, 0.3, 1.0}) {
    const double ratio = likelihood_ratio(z, 0.3, config, visible);
    EXPECT_GT(after_list(0.4, ratio, config, visible), 0.4) << "an observation counts wherever it is";
    association::JointAssociation joint(1, 1);
    const association::Pair lone[] = {{0, 0, joint_weight(0.4, ratio, config, visible)}};
    joint.solve(lone, 1, 1);
    EXPECT_NEAR(joint.of_column(0)[0].probability + joint.none_of_column(0) * exists_unseen(0.4, config, visible),
                after_list(0.4, ratio, config, visible), 1e-15);
  }
}

TEST(Existence, ClutterOfARadarIsThatOfThePlane) {
  config::TrackerConfig config;
  config.clutter_density = 0.02;
  config.initial_velocity_sigma = 5.0;
  EXPECT_EQ(clutter_at(position(30.0, 2.0, 0.1), config), 0.02);
  // Over ranges to R, all bearings and the full width of range rates: as many as in the disc.
  const double width = 2.0 * std::sqrt(3.0) * 5.0, radius = 40.0;
  double sum = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double r = radius * (i + 0.5) / 4000.0;
    sum += clutter_at(radar(r, 0.0, 0.0, 0.1, 0.1, 0.1), config) * width * 2.0 * kPi * radius / 4000.0;
  }
  EXPECT_NEAR(sum / (0.02 * kPi * radius * radius), 1.0, 1e-5);
}

// Confirmed from confirm_existence on, ended below delete_existence; nothing else counts.
TEST_P(EveryAssociation, ATrackIsBornAndEndsByItsExistence) {
  const config::TrackerConfig config = by_existence(GetParam());
  Tracker tracker(config, 8);
  TrackSet set(tracker.max_tracks());
  bool was_confirmed = false, ended = false;
  for (std::uint32_t k = 0; k < 40; ++k) {
    std::vector<sensors::Observation> list;
    if (k < 10) list.push_back(position(20.0, 3.0, 0.2));
    tracker.step(set, list_of(0, k, at_ms(50 * k), list).view());
    if (set.tracks.empty()) {
      ended = true;
      continue;
    }
    ASSERT_EQ(set.tracks.size(), 1u);
    const Track& track = set.tracks[0];
    was_confirmed = was_confirmed || track.existence >= config.confirm_existence;
    EXPECT_EQ(track.confirmed, was_confirmed) << k;
    EXPECT_GE(track.existence, config.delete_existence) << k;
  }
  EXPECT_TRUE(was_confirmed);
  EXPECT_TRUE(ended);
}

// An object seen once ends within a few lists. In clutter as dense as assumed, few false tracks are believed,
// and the true one among them is.
TEST_P(EveryAssociation, ClutterIsSeldomBelieved) {
  config::TrackerConfig config = by_existence(GetParam());
  config.clutter_density = 0.01;
  config.initial_existence = 0.05;
  Tracker tracker(config, 64);
  TrackSet set(tracker.max_tracks());
  RandomStream stream({.seed = 5});
  int false_confirmed = 0, true_confirmed = 0, lists = 0;
  for (std::uint32_t k = 0; k < 400; ++k) {
    std::vector<sensors::Observation> list;
    if (stream.uniform() < 0.8) list.push_back(position(30.0 + 0.2 * stream.normal(), 0.2 * stream.normal(), 0.2));
    // 60 m by 20 m: 12 to a list.
    for (int i = 0; i < 12; ++i) list.push_back(position(stream.uniform(0.0, 60.0), stream.uniform(-10.0, 10.0), 0.2));
    tracker.step(set, list_of(0, k, at_ms(50 * k), list).view());
    if (k < 20) continue;
    ++lists;
    for (const Track& track : set.tracks) {
      if (!track.confirmed) continue;
      const estimators::State x = state_of(track);
      (std::hypot(x(0) - 30.0, x(1)) < 1.0 ? true_confirmed : false_confirmed) += 1;
    }
  }
  EXPECT_GT(true_confirmed, 0.97 * lists);
  EXPECT_LT(false_confirmed, 0.15 * lists);
  RecordProperty("false_tracks_per_list", std::to_string(static_cast<double>(false_confirmed) / lists));
  RecordProperty("true_tracks_per_list", std::to_string(static_cast<double>(true_confirmed) / lists));
}

// Seen in the last two of ten lists. The odds have the weight twice: at birth, and in the list after it.
TEST(Existence, GrowsMoreSlowlyByDoubtfulObservations) {
  config::TrackerConfig config;
  config.birth = config::Birth::kExistence;
  config.clutter_density = 0.05;
  const auto existence_by = [&](double weight) {
    Bench bench(config);
    for (int k = 0; k < 10; ++k) {
      sensors::Observation z = position(20.0, 0.0, 0.05);
      z.weight = weight;
      bench.step(100 * k, k < 8 ? std::vector<sensors::Observation>{} : std::vector{z});
    }
    EXPECT_EQ(bench.set.tracks.size(), 1u);
    return bench.set.tracks.at(0).existence;
  };
  const double sure = existence_by(1.0), doubtful = existence_by(0.3);
  EXPECT_LT(doubtful, sure);
  const auto odds = [](double existence) { return existence / (1.0 - existence); };
  EXPECT_LT(odds(doubtful), 0.3 * odds(sure));
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
