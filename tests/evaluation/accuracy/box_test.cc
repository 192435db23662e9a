// Visible faces, gaps and their errors: by hand, and against a plain search along the box' outline.
#include "evaluation/accuracy/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace ttf::evaluation::accuracy {
namespace {

using fusion::metrics::Point;
constexpr double kPi = std::numbers::pi;

Box car(double x, double y, double heading) { return {x, y, heading, 4.6, 1.8}; }

//   origin >      [rear   car   front] ->        x
TEST(VisibleFace, OfACarAheadIsItsRear) {
  EXPECT_EQ(visible_face(car(30, 0, 0)), Face::kRear);
  EXPECT_EQ(visible_face(car(30, 3.5, 0)), Face::kRear);
  EXPECT_EQ(visible_face(car(30, 0, kPi)), Face::kFront) << "an oncoming car";
  EXPECT_EQ(visible_face(car(-20, 0, 0)), Face::kFront) << "a follower";
  EXPECT_EQ(visible_face(car(30, 0, kPi / 2)), Face::kLeft) << "crossing to the left";
  EXPECT_EQ(visible_face(car(30, 0, -kPi / 2)), Face::kRight) << "crossing to the right";
}

// A car falls back in the next lane on the left.
TEST(VisibleFace, OfACarAlongsideChangesOnlyWhereItsFaceIsTurnedAway) {
  EXPECT_EQ(visible_face(car(6.0, 3.0, 0)), Face::kRear);
  // The origin is abreast of the car. The rear's middle is nearer, but turned away.
  EXPECT_LT(std::hypot(2.2 - 2.3, 3.0), std::hypot(2.2, 3.0 - 0.9));
  EXPECT_EQ(visible_face(car(2.2, 3.0, 0)), Face::kRight);
  EXPECT_EQ(visible_face(car(0.0, 3.0, 0)), Face::kRight);
  EXPECT_EQ(visible_face(car(0.0, -3.0, 0)), Face::kLeft);
  EXPECT_EQ(visible_face(car(-6.0, 3.0, 0)), Face::kFront);
}

TEST(VisibleFace, FromWithinTheBoxIsTheNearest) {
  EXPECT_EQ(visible_face(car(0.0, 0.5, 0)), Face::kRight);
  EXPECT_EQ(visible_face(car(2.2, 0.0, 0)), Face::kRear);
}

TEST(VisibleFace, ItsMiddleIsHalfALengthOrAWidthFromTheCentre) {
  const Box box = car(30, 2, kPi / 2);
  const auto expect_at = [&](Face face, double x, double y) {
    EXPECT_NEAR(middle_of(box, face).x, x, 1e-12);
    EXPECT_NEAR(middle_of(box, face).y, y, 1e-12);
  };
  expect_at(Face::kRear, 30, 2 - 2.3);
  expect_at(Face::kFront, 30, 2 + 2.3);
  expect_at(Face::kRight, 30.9, 2);
  expect_at(Face::kLeft, 29.1, 2);
}

TEST(Gap, ByHand) {
  EXPECT_NEAR(gap_m(car(30, 0, 0)), 27.7, 1e-12);
  EXPECT_NEAR(gap_m(car(30, 0, kPi)), 27.7, 1e-12);
  EXPECT_NEAR(gap_m(car(30, 0, kPi / 2)), 29.1, 1e-12);
  EXPECT_NEAR(gap_m(car(0, -10, 0)), 9.1, 1e-12);
  // Along the diagonal of 30 m and 40 m the rear lies 2.3 m nearer in x: 50 m less 2.3 / 0.6.
  EXPECT_NEAR(gap_m({30, 40, 0, 4.6, 20}), 50.0 - 2.3 / 0.6, 1e-12);
  EXPECT_EQ(gap_m(car(1, 0, 0)), 0.0) << "within the box";
  EXPECT_EQ(gap_m({0, 0, 0, 0, 0}), 0.0);
  EXPECT_EQ(gap_m({0, 5, 0, 0, 0}), 5.0) << "a point";
}

// Steps along the line of sight to the first point of the box. The visible face has the nearest middle of those in sight.
TEST(Box, AgreesWithASearchAlongItsOutline) {
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream draw({.seed = 61, .purpose = Purpose::kTest, .index = index});
    const Box box{draw.uniform(-30, 30), draw.uniform(-30, 30), draw.uniform(-7, 7), draw.uniform(1, 12),
                  draw.uniform(0.5, 3)};
    if (std::hypot(box.x, box.y) < 8.0) continue;  // outside
    const double c = std::cos(box.heading), s = std::sin(box.heading);
    const auto place = [&](double along, double across) {
      return Point{box.x + c * along - s * across, box.y + s * along + c * across};
    };
    // Towards the centre, in steps of a millimetre, until the point is in the box.
    const double range = std::hypot(box.x, box.y);
    double gap = 0.0;
    for (; gap < range; gap += 1e-3) {
      const double dx = box.x * (gap / range - 1.0), dy = box.y * (gap / range - 1.0);
      if (std::abs(c * dx + s * dy) <= box.length / 2 && std::abs(-s * dx + c * dy) <= box.width / 2) break;
    }
    ASSERT_NEAR(gap_m(box), gap, 2e-3) << index;

    const struct {
      Face face;
      Point middle, beyond;  // a point just outside
    } faces[] = {
        {Face::kRear, place(-box.length / 2, 0), place(-box.length / 2 - 1e-6, 0)},
        {Face::kFront, place(box.length / 2, 0), place(box.length / 2 + 1e-6, 0)},
        {Face::kRight, place(0, -box.width / 2), place(0, -box.width / 2 - 1e-6)},
        {Face::kLeft, place(0, box.width / 2), place(0, box.width / 2 + 1e-6)},
    };
    double least = 1e9;
    Face nearest = Face::kRear;
    for (const auto& one : faces) {
      ASSERT_NEAR(distance_m(middle_of(box, one.face), one.middle), 0.0, 1e-12);
      // In sight: the middle, seen from the origin, is nearer than the same point moved into the box.
      const Point normal{one.beyond.x - one.middle.x, one.beyond.y - one.middle.y};
      if (normal.x * -one.middle.x + normal.y * -one.middle.y <= 0.0) continue;
      if (const double distance = std::hypot(one.middle.x, one.middle.y); distance < least) {
        least = distance;
        nearest = one.face;
      }
    }
    ASSERT_EQ(visible_face(box), nearest) << index;
  }
}

TEST(BoxError, OfTheSameBoxIsNothing) {
  const BoxError error = error_of(car(30, 2, 0.3), car(30, 2, 0.3));
  EXPECT_EQ(error.face_m, 0.0);
  EXPECT_EQ(error.gap_m, 0.0);
  EXPECT_EQ(error.heading_rad, 0.0);
  EXPECT_EQ(error.length_m, 0.0);
  EXPECT_EQ(error.width_m, 0.0);
}

// Centre right, a metre too long: the rear is half a metre too near.
TEST(BoxError, ALengthMovesTheFaceByHalf) {
  const BoxError error = error_of({30, 0, 0, 5.6, 1.8}, car(30, 0, 0));
  EXPECT_NEAR(error.face_m, 0.5, 1e-12);
  EXPECT_NEAR(error.gap_m, -0.5, 1e-12);
  EXPECT_NEAR(error.length_m, 1.0, 1e-12);
  EXPECT_EQ(error.width_m, 0.0);
}

// A box turned round has its face where the true one has it, and errs by half a turn.
TEST(BoxError, ABoxTurnedRoundErrsInItsHeadingAlone) {
  const BoxError error = error_of(car(30, 0, kPi), car(30, 0, 0));
  EXPECT_NEAR(error.face_m, 0.0, 1e-12);
  EXPECT_NEAR(error.gap_m, 0.0, 1e-12);
  EXPECT_NEAR(std::abs(error.heading_rad), kPi, 1e-12);
}

TEST(BoxError, HeadingsDifferByHalfATurnAtMost) {
  EXPECT_NEAR(error_of(car(30, 0, 3.1), car(30, 0, -3.1)).heading_rad, 6.2 - 2 * kPi, 1e-12);
  EXPECT_NEAR(error_of(car(30, 0, -3.1), car(30, 0, 3.1)).heading_rad, 2 * kPi - 6.2, 1e-12);
}

// Where the true visible face changes, a slightly wrong box keeps to the true one.
TEST(BoxError, ASlightErrorStaysSlightWhereTheVisibleFaceChanges) {
  for (double x = -8.0; x <= 8.0; x += 0.01) {
    const BoxError error = error_of(car(x + 0.02, 3.03, 0.01), car(x, 3.0, 0.0));
    ASSERT_LT(error.face_m, 0.1) << x;
  }
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
