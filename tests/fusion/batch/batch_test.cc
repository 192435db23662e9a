// A batch of filters against single filters::Kalman of constant velocity and positions, bit for bit.
#include "fusion/batch/batch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "fusion/filters/kalman.h"
#include "fusion/sensors/position.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::batch {
namespace {

using sensors::Measurement;

constexpr std::size_t kFilters = 101;  // the last block is not full
constexpr int kSteps = 60;
const motion::ConstantVelocity kModel(3.0);

// Draws any valid state and measurement of a form.
template <template <class> class Form> linear::Gaussian<4> prior(RandomStream& stream) {
  linear::Gaussian<4> state;
  state.x = motion::drawn<4>(linear::Vector<4>::Zero(), 100.0 * linear::Matrix<4>::Identity(), stream);
  state.p = motion::drawn_covariance<4>(stream, 5.0);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      if (std::is_same_v<Form<double>, batch::Axes<double>> && (r + c) % 2 == 1) state.p(r, c) = 0.0;
  return state;
}
template <template <class> class Form> sensors::Measurement<2> seen(RandomStream& stream) {
  sensors::Measurement<2> z;
  z.z = motion::drawn<2>(linear::Vector<2>::Zero(), 100.0 * linear::Matrix<2>::Identity(), stream);
  z.r = motion::drawn_covariance<2>(stream, 0.3);
  if (std::is_same_v<Form<double>, batch::Axes<double>>) z.r(0, 1) = z.r(1, 0) = 0.0;
  return z;
}

bool same_bits(const linear::Gaussian<4>& a, const linear::Gaussian<4>& b) {
  // A zero has no sign here.
  return a.x == b.x && a.p == b.p;
}

// One step of 1..99 ms after the other; one in four is not measured.
template <template <class> class Form, class Step> void equals_one_at_a_time(const Step& step) {
  RandomStream stream({.seed = 5});
  batch::Batch<Form> batch(kFilters);
  std::vector<linear::Gaussian<4>> alone;
  for (std::size_t i = 0; i < kFilters; ++i) {
    alone.push_back(prior<Form>(stream));
    batch.set(i, alone.back());
    ASSERT_TRUE(same_bits(batch.state(i), alone.back()));
  }
  const filters::Kalman filter;
  batch::Positions z(kFilters);
  for (int k = 0; k < kSteps; ++k) {
    const double dt = 0.001 * (1 + (k * 37) % 99);
    for (std::size_t i = 0; i < kFilters; ++i) {
      filter.predict(kModel, alone[i], dt);
      if (stream.uniform() < 0.25) {
        z.clear(i);
        continue;
      }
      const sensors::Measurement<2> one = seen<Form>(stream);
      z.set(i, one);
      filter.update(kModel, sensors::Position{}, one, alone[i]);
    }
    step(batch, batch::Step(kModel, dt), z);
    for (std::size_t i = 0; i < kFilters; ++i)
      ASSERT_TRUE(same_bits(batch.state(i), alone[i])) << "filter " << i << ", step " << k;
  }
}

const auto kOneAfterTheOther = [](auto& batch, const batch::Step& by, const batch::Positions& z) {
  batch.predict(by);
  batch.update(z);
};
const auto kBothInOne = [](auto& batch, const batch::Step& by, const batch::Positions& z) { batch.step(by, z); };

TEST(Batch, L1_L2_AxesAreTheFilterAloneToTheBit) { equals_one_at_a_time<batch::Axes>(kOneAfterTheOther); }
TEST(Batch, L1_L2_AxesInOneStepToo) { equals_one_at_a_time<batch::Axes>(kBothInOne); }
TEST(Batch, L1_L2_JointIsTheFilterAloneToTheBit) { equals_one_at_a_time<batch::Joint>(kOneAfterTheOther); }
TEST(Batch, L1_L2_JointInOneStepToo) { equals_one_at_a_time<batch::Joint>(kBothInOne); }

// The scalar form is the same source; so is the NIS that an update returns.
TEST(Batch, TheNisIsThatOfTheFilterAlone) {
  RandomStream stream({.seed = 6});
  const filters::Kalman filter;
  for (int i = 0; i < 200; ++i) {
    linear::Gaussian<4> alone = prior<batch::Joint>(stream);
    const sensors::Measurement<2> z = seen<batch::Joint>(stream);
    batch::Joint<double> joint;
    for (int c = 0; c < 4; ++c) {
      joint.x[c] = alone.x(c);
      for (int r = 0; r <= c; ++r) joint.p[batch::Joint<double>::at(r, c)] = alone.p(r, c);
    }
    const double nis = batch::update(joint, {z.z(0), z.z(1), z.r(0, 0), z.r(0, 1), z.r(1, 1), true});
    EXPECT_EQ(nis, filter.update(kModel, sensors::Position{}, z, alone).nis);
    EXPECT_EQ(joint.x[3], alone.x(3));
    EXPECT_EQ(joint.p[9], alone.p(3, 3));
  }
}

TEST(Batch, L3_NoHeap) {
  batch::Batch<batch::Joint> batch(kFilters);
  batch::Positions z(kFilters);
  linear::Gaussian<4> state;
  state.p.setIdentity();
  const auto before = support::allocations();
  for (std::size_t i = 0; i < kFilters; ++i) batch.set(i, state), z.set(i, {});
  for (int k = 0; k < 10; ++k) batch.step(batch::Step(kModel, 0.04), z);
  EXPECT_EQ(support::allocations(), before);
}

TEST(BatchDeathTest, AxesThatAreCorrelatedAreNoAxes) {
  batch::Batch<batch::Axes> batch(1);
  linear::Gaussian<4> state;
  state.p.setIdentity();
  state.p(0, 3) = state.p(3, 0) = 0.1;
  EXPECT_DEATH(batch.set(0, state), "the axes are correlated");
}

}  // namespace
}  // namespace ttf::fusion::batch
