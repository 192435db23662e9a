// Interacting multiple models: against one filter, against probabilities by hand, and on a drive with a
// straight and a bend.
#include "fusion/filters/imm.h"
#include "fusion/filters/extended.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::filters {
namespace {

using motion::ConstantVelocity, motion::Ctrv;
using sensors::Measurement;
using sensors::Position;

const sensors::Measurement<2> kSeen{{1.0, -0.5}, 0.04 * linear::Matrix<2>::Identity()};

TEST(Imm, WithOneModelIsThatFilter) {
  const ConstantVelocity model(0.5);
  const Imm<Kalman, ConstantVelocity> imm({}, model);
  Modes<ConstantVelocity> modes;
  linear::Gaussian<4>& one = std::get<0>(modes.estimates);
  one.x << 1.0, 2.0, 3.0, 4.0;
  one.p.setIdentity();
  linear::Gaussian<4> alone = one;
  for (int k = 0; k < 10; ++k) {
    imm.predict(modes, 0.1);
    Kalman{}.predict(model, alone, 0.1);
    const Innovation<2> a = imm.update(Position{}, kSeen, modes), b = Kalman{}.update(model, Position{}, kSeen, alone);
    EXPECT_TRUE((motion::same<4, 1>(one.x, alone.x)));
    EXPECT_TRUE((motion::same<4, 4>(one.p, alone.p)));
    EXPECT_TRUE((motion::same<2, 1>(a.nu, b.nu)));
    EXPECT_EQ(a.nis, b.nis);
    EXPECT_EQ(modes.probability(0), 1.0);
  }
}

using Two = Modes<ConstantVelocity, ConstantVelocity>;
const Imm<Kalman, ConstantVelocity, ConstantVelocity> kTwo({}, ConstantVelocity(0.1), ConstantVelocity(10.0));

Two two_at(double first, double second) {
  Two modes;
  std::get<0>(modes.estimates).x << first, 0.0, 0.0, 0.0;
  std::get<1>(modes.estimates).x << second, 0.0, 0.0, 0.0;
  std::get<0>(modes.estimates).p = 1.0 * linear::Matrix<4>::Identity();
  std::get<1>(modes.estimates).p = 4.0 * linear::Matrix<4>::Identity();
  modes.probability << 0.6, 0.4;
  return modes;
}

// By hand: c_1 = 0.9 0.6 + 0.2 0.4 = 0.62, c_2 = 0.38; mode 1 starts from 0.54/0.62 of itself and 0.08/0.62 of mode 2.
TEST(Imm, MixesAsByHand) {
  Two modes = two_at(0.0, 3.0);
  linear::Matrix<2> p;
  p << 0.9, 0.1, 0.2, 0.8;
  kTwo.mix(modes, p);
  EXPECT_NEAR(modes.probability(0), 0.62, 1e-15);
  EXPECT_NEAR(modes.probability(1), 0.38, 1e-15);
  const double w = 0.08 / 0.62, mean = 3.0 * w;
  EXPECT_NEAR(std::get<0>(modes.estimates).x(0), mean, 1e-15);
  const double variance = (1.0 - w) * (1.0 + mean * mean) + w * (4.0 + (3.0 - mean) * (3.0 - mean));
  EXPECT_NEAR(std::get<0>(modes.estimates).p(0, 0), variance, 1e-14);
  EXPECT_NEAR(std::get<0>(modes.estimates).p(1, 1), (1.0 - w) * 1.0 + w * 4.0, 1e-15);
  EXPECT_NEAR(std::get<1>(modes.estimates).x(0), 3.0 * 0.32 / 0.38, 1e-14);
}
// L = N(nu; 0, S) with S = 1.04 I and 4.04 I.
TEST(Imm, WeighsByLikelihood) {
  Two modes = two_at(0.0, 3.0);
  const Innovation<2> innovation = kTwo.update(Position{}, kSeen, modes);
  const double first = 0.6 * std::exp(-0.5 * (1.0 + 0.25) / 1.04) / 1.04;
  const double second = 0.4 * std::exp(-0.5 * (4.0 + 0.25) / 4.04) / 4.04;
  EXPECT_NEAR(modes.probability(0), first / (first + second), 1e-14);
  EXPECT_NEAR(innovation.nu(0), 0.6 * 1.0 + 0.4 * -2.0, 1e-14);
  EXPECT_NEAR(innovation.s(0, 0), 0.6 * 1.04 + 0.4 * 4.04 + 0.6 * 0.4 * 9.0, 1e-13);
}
// Ten thousand sigmas away: logarithms do not underflow.
TEST(Imm, SurvivesWhatIsFarAway) {
  Two modes = two_at(0.0, 3.0);
  kTwo.update(Position{}, {{1e6, 0.0}, kSeen.r}, modes);
  EXPECT_NEAR(modes.probability.sum(), 1.0, 1e-15);
  EXPECT_NEAR(modes.probability(1), 1.0, 1e-15);
}
// The first list leaves mode 0 with zero probability. The second, of the same instant, supports mode 0 and
// contradicts mode 1.
TEST(Imm, SurvivesWhatContradictsItself) {
  Two modes = two_at(0.0, 3.0);
  kTwo.update(Position{}, {{1e6, 0.0}, kSeen.r}, modes);
  ASSERT_EQ(modes.probability(0), 0.0);
  EXPECT_LT(std::get<0>(modes.estimates).x(0), std::get<1>(modes.estimates).x(0) - 1e4);
  const Innovation<2> second = kTwo.update(Position{}, {{9e5, 0.0}, kSeen.r}, modes);
  EXPECT_TRUE(std::isfinite(second.nis));
  EXPECT_EQ(modes.probability(0), 0.0);
  EXPECT_EQ(modes.probability(1), 1.0);
  kTwo.predict(modes, 0.5);
  EXPECT_NEAR(modes.probability(0), 0.5 * (1.0 - std::exp(-0.1)), 1e-15) << "time leads back to it";
  EXPECT_TRUE(std::get<0>(modes.estimates).x.allFinite() && std::get<0>(modes.estimates).p.allFinite());
}
// One mode expects the bearing 0.01 rad, the other -0.01 rad. A measurement half a turn off is nearly half a
// turn to the left of one and to the right of the other. They are neighbours, as they are at one radian.
TEST(Imm, BearingsAverageAsAngles) {
  const auto measured = [](double bearing) {
    const Imm<Extended, ConstantVelocity, ConstantVelocity> imm({}, ConstantVelocity(0.1), ConstantVelocity(10.0));
    Two modes = two_at(50.0 * std::cos(0.01), 50.0 * std::cos(0.01));
    std::get<0>(modes.estimates).x(1) = 50.0 * std::sin(0.01);
    std::get<1>(modes.estimates).x(1) = -50.0 * std::sin(0.01);
    const sensors::Measurement<2> z{{50.0, bearing}, linear::Vector<2>(0.01, 0.0001).asDiagonal()};
    return imm.update(sensors::RangeBearing{}, z, modes);
  };
  const Innovation<2> aside = measured(1.0), behind = measured(std::numbers::pi);
  EXPECT_NEAR(aside.nu(1), 1.0 - 0.6 * 0.01 + 0.4 * 0.01, 1e-14);
  EXPECT_NEAR(behind.nu(1), std::numbers::pi - 0.6 * 0.01 + 0.4 * 0.01, 1e-14);
  EXPECT_LT((motion::apart<2, 2>(behind.s, aside.s)), 1e-14);
  const Innovation<2> beyond = measured(-std::numbers::pi + 0.004);
  EXPECT_NEAR(beyond.nu(1), -std::numbers::pi + 0.002, 1e-14) << "their mean is beyond half a turn";
  EXPECT_LT((motion::apart<2, 2>(beyond.s, aside.s)), 1e-14);
}
TEST(Imm, NothingChangesWithinNoTime) {
  Two modes = two_at(0.0, 3.0);
  kTwo.predict(modes, 0.0);
  EXPECT_EQ(modes.probability(0), 0.6);
  EXPECT_EQ(modes.probability(1), 0.4);
  EXPECT_EQ(std::get<0>(modes.estimates).x(0), 0.0);
  EXPECT_EQ(std::get<1>(modes.estimates).x(0), 3.0);
}

TEST(ModeChain, OneStepIsTwoSteps) {
  const ModeChain<3> chain{{0.5, 0.3, 0.2}, 2.0};
  const linear::Matrix<3> twice = motion::times<3, 3, 3>(chain.transition(0.3), chain.transition(0.9)),
                          once = chain.transition(1.2);
  EXPECT_LT((motion::apart<3, 3>(twice, once)), 1e-15);
  EXPECT_NEAR(once.row(1).sum(), 1.0, 1e-15);
  EXPECT_LT((motion::apart<1, 3>(linear::Matrix<1, 3>(chain.share.transpose() * once),
                                 linear::Matrix<1, 3>(chain.share.transpose()))),
            1e-15);
}

// Ten seconds straight on, ten along a bend of 0.4 rad/s, seen every 0.1 s. The mode follows. The mixture is
// nearer to the truth than the model without bends.
TEST(Imm, FollowsTheManoeuvre) {
  using All = Modes<ConstantVelocity, Ctrv>;
  const ConstantVelocity straight(0.01);
  const Ctrv bend(0.3, 0.1);
  const Imm<Extended, ConstantVelocity, Ctrv> imm({.seconds = 5.0}, straight, bend);
  RandomStream stream({.seed = 20});
  linear::Vector<5> truth;
  truth << 0.0, 0.0, 0.3, 10.0, 0.0;
  All modes;
  linear::Gaussian<4>& on_straight = std::get<0>(modes.estimates);
  on_straight.x << 0.0, 0.0, 10.0 * std::cos(0.3), 10.0 * std::sin(0.3);
  on_straight.p.setIdentity();
  std::get<1>(modes.estimates).x = truth;
  std::get<1>(modes.estimates).p = linear::Vector<5>(1.0, 1.0, 0.01, 1.0, 0.25).asDiagonal();
  linear::Gaussian<4> only_straight = on_straight;
  double off_mixed = 0.0, off_straight = 0.0, turning[2] = {};
  std::int64_t allocations = 0;
  for (int k = 0; k < 200; ++k) {
    truth(4) = k < 100 ? 0.0 : 0.4;
    truth = bend.move(truth, 0.1);
    sensors::Measurement<2> z{truth.head<2>(), 0.01 * linear::Matrix<2>::Identity()};
    for (int i = 0; i < 2; ++i) z.z(i) += 0.1 * stream.normal();
    const std::int64_t before = support::allocations();
    imm.predict(modes, 0.1);
    const double asked = imm.innovate(Position{}, z, modes).nis;
    const Innovation<2> innovation = imm.update(Position{}, z, modes);
    EXPECT_EQ(asked, innovation.nis);
    const linear::Gaussian<6> mixed = imm.whole(modes);
    allocations += support::allocations() - before;
    Extended{}.predict(straight, only_straight, 0.1);
    Extended{}.update(straight, Position{}, z, only_straight);
    EXPECT_NEAR(modes.probability.sum(), 1.0, 1e-14);
    off_mixed += (mixed.x.head<2>() - truth.head<2>()).squaredNorm();
    off_straight += (only_straight.x.head<2>() - truth.head<2>()).squaredNorm();
    if (k % 100 >= 50) turning[k / 100] += modes.probability(1) / 50.0;
  }
  EXPECT_LT(turning[0], 0.5);
  EXPECT_GT(turning[1], 0.9);
  EXPECT_LT(off_mixed, 0.1 * off_straight);
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace ttf::fusion::filters
