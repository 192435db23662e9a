// The bounds of returns over outlines, against drawn points.
#include "fusion/tracks/resolution/return_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fusion/scenes.h"
#include "tests/fusion/tracks/body/drawn_outline.h"

namespace ttf::fusion::tracks::resolution {
namespace {

using body::DrawnOutline, body::SeenBox, body::range_rate_of, body::seen_car;

TEST(ReturnBounds, HoldTheDrawnPointsOfTheVisibleOutline) {
  for (const SeenBox& o :
       {seen_car(45.0, 0.0, 0.0, 3.0), seen_car(20.0, 3.5, 0.0, 8.0), seen_car(3.0, 2.5, 0.1, 8.0),
        seen_car(25.0, 5.0, 1.5, 5.0), seen_car(30.0, -8.0, 2.4, 8.0, 0.5), seen_car(6.0, 0.0, 0.0, -20.0)}) {
    const ReturnBounds bounds = bounds_of(o);
    const DrawnOutline drawn(o.centre, o.box);
    RandomStream stream({1, 0, Purpose::kTest, 0, 0});
    linear::Vector<3> low = linear::Vector<3>::Constant(1e9), high = -low;
    for (int k = 0; k < 4'000; ++k) {
      const linear::Vector<2> at = drawn.draw(stream);
      const linear::Vector<3> point(at(0), at(1), range_rate_of(at, o.centre, o.velocity, o.turn_rate));
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    const linear::Vector<3> near(0.05, 0.02, 0.05);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bounds.low(k), low(k), near(k)) << o.centre.transpose() << ": " << k;
      EXPECT_NEAR(bounds.high(k), high(k), near(k)) << o.centre.transpose() << ": " << k;
    }
  }
}

TEST(ReturnBounds, OfOutlinesJoinUpToTheGates) {
  const sensors::Resolution radar{5.0, 2.5, 0.003, 1.0, 0.0, 60.0};
  const auto join = [&](const SeenBox& a, const SeenBox& b) {
    EXPECT_EQ(may_join(bounds_of(a), bounds_of(b), radar), may_join(bounds_of(b), bounds_of(a), radar));
    return may_join(bounds_of(a), bounds_of(b), radar);
  };
  const SeenBox one = seen_car(20.0, 1.75, 0.0, 8.0);
  EXPECT_TRUE(join(one, seen_car(20.0, -1.75, 0.0, 8.0))) << "side by side";
  EXPECT_FALSE(join(one, seen_car(20.0, -5.25, 0.0, 8.0))) << "a lane apart";
  EXPECT_FALSE(join(one, seen_car(20.0, -1.75, 0.0, 10.0))) << "another range rate";
  EXPECT_TRUE(join(one, seen_car(20.0, -1.75, 0.0, 68.0))) << "the same one, but for the span";
  EXPECT_FALSE(join(one, seen_car(36.0, 1.75, 0.0, 8.0))) << "ahead";
}

TEST(ReturnBounds, JoinBehindTheSensorToo) {
  const sensors::Resolution radar{5.0, 2.5, 0.003, 1.0, 0.0, 60.0};
  EXPECT_TRUE(may_join(bounds_of(seen_car(-20.0, 1.75, 0.0, 8.0)), bounds_of(seen_car(-20.0, -1.75, 0.0, 8.0)), radar));
}

}  // namespace
}  // namespace ttf::fusion::tracks::resolution
