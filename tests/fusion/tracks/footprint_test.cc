// Whether the places of two objects overlap.
#include "fusion/tracks/footprint.h"

#include <gtest/gtest.h>

namespace ttf::fusion::tracks {
namespace {

TEST(OverlapDepth, IsThatOfTheShortestWayApart) {
  const Footprint at_origin{0, 0, 0, 4, 2};
  EXPECT_NEAR(overlap_depth(at_origin, {3, 0, 0, 4, 2}), 1.0, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {5, 0, 0, 4, 2}), -1.0, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {0, 1.5, 0, 4, 2}), 0.5, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {0, 3.5, 1.5707963267948966, 4, 2}), -0.5, 1e-12);
  // Their axes' boxes overlap, they do not: a corner looks past a corner.
  EXPECT_LT(overlap_depth(at_origin, {3.4, 2.6, 0.785398163, 4, 2}), 0.0);
  EXPECT_NEAR(overlap_depth(at_origin, {1, 0.3, 0.4, 3, 1}), overlap_depth({1, 0.3, 0.4, 3, 1}, at_origin), 1e-12);
}

}  // namespace
}  // namespace ttf::fusion::tracks
