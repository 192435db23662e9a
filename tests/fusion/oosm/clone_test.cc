// A clone's announcements, and measurements that were not announced.
#include "fusion/oosm/clone.h"

#include <gtest/gtest.h>

#include "tests/fusion/oosm/timelines.h"

namespace ttf::fusion::oosm {
namespace {

class Announced : public testing::Test {
 protected:
  static linear::LinearMeasurement<2, 1> position(double z) {
    return {linear::Vector<1>(z), linear::Matrix<1, 2>(1.0, 0.0), linear::Matrix<1>(1.0)};
  }
  static Stamp list_of(int i) { return stamp_at(after_ms(100 * i)); }
  static Stamp between(int i) { return stamp_at(after_ms(100 * i + 50), 1); }

  Announced() { method_.start(GlobalTime{}, {linear::Vector<2>::Zero(), linear::Matrix<2>::Identity()}); }

  Clone<2, 1, ConstantVelocity<1>, 2> method_{ConstantVelocity<1>{}};
};

TEST_F(Announced, LateWithoutAWordIsNotTaken) {
  method_.take(list_of(1), position(1));
  method_.take(list_of(2), position(2));
  const linear::Gaussian<2> before = method_.state();
  EXPECT_FALSE(method_.announce(between(1)));  // too late
  EXPECT_EQ(method_.take(between(1), position(1)), Taken::kUnannounced);
  EXPECT_TRUE(same_bits<2>(method_.state(), before));
  EXPECT_EQ(method_.take(list_of(3), position(3)), Taken::kInOrder);
}

TEST_F(Announced, ATimeThatIsKeptNeedsNoClone) {
  EXPECT_TRUE(method_.announce(list_of(1)));
  EXPECT_EQ(method_.take(list_of(1), position(1)), Taken::kInOrder);
  EXPECT_EQ(method_.take(list_of(1), position(1)), Taken::kDuplicate);
  EXPECT_EQ(method_.take(list_of(2), position(1)), Taken::kInOrder);
  EXPECT_EQ(method_.take(list_of(1), position(1)), Taken::kUnannounced);
}

TEST_F(Announced, ACloneServesOnce) {
  EXPECT_TRUE(method_.announce(between(0)));
  EXPECT_TRUE(method_.announce(between(0)));  // again: still one
  method_.take(list_of(1), position(1));
  EXPECT_EQ(method_.take(between(0), position(1)), Taken::kLate);
  EXPECT_EQ(method_.take(between(0), position(1)), Taken::kUnannounced);
}

TEST_F(Announced, TheOldestGoesWhenAllAreInUse) {
  EXPECT_TRUE(method_.announce(between(1)));
  EXPECT_TRUE(method_.announce(between(0)));
  EXPECT_FALSE(method_.announce(between(2)));  // there is room for two
  method_.take(list_of(2), position(1));
  EXPECT_TRUE(method_.announce(between(2)));
  method_.take(list_of(3), position(1));
  EXPECT_EQ(method_.take(between(0), position(1)), Taken::kTooOld);
  EXPECT_EQ(method_.take(between(2), position(1)), Taken::kLate);
  EXPECT_EQ(method_.take(between(1), position(1)), Taken::kLate);
}

}  // namespace
}  // namespace ttf::fusion::oosm
