// Both readings of a rectangle: which of its sides is the length.
#include "fusion/tracks/body/reading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/motion/angles.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

sensors::Observation end_of(double heading, double width) {
  sensors::Observation z = position(20.0, 3.0, 0.05);
  z.seen = SeenPoint::kEnd;
  z.has_heading = z.has_width = true;
  z.heading = heading;
  z.sigma_heading = 0.02;
  z.width = width;
  z.sigma_width = 0.05;
  return z;
}

Extent extent_of(double length, double width) {
  Extent extent;
  extent.size << length, width;
  extent.covariance << 0.01, 0.0, 0.0, 0.01;
  return extent;
}

TEST(Reading, AnEndIsASideOfTheSameFaceAndBackAgain) {
  const sensors::Observation end = end_of(0.3, 2.1), side = read_otherwise(end), back = read_otherwise(side);
  EXPECT_EQ(side.seen, SeenPoint::kSide);
  EXPECT_TRUE(side.has_length && !side.has_width);
  EXPECT_EQ(side.length, 2.1);
  EXPECT_EQ(side.sigma_length, 0.05);
  EXPECT_NEAR(side.heading, 0.3 + 0.5 * kPi, 1e-12);
  EXPECT_EQ(side.z, end.z);
  EXPECT_EQ(side.r, end.r);
  EXPECT_EQ(back.seen, SeenPoint::kEnd);
  EXPECT_TRUE(back.has_width && !back.has_length);
  EXPECT_EQ(back.width, 2.1);
  EXPECT_NEAR(nearest_half_turn(back.heading, end.heading), end.heading, 1e-12);
  for (const SeenPoint seen : {SeenPoint::kCorner, SeenPoint::kSilhouette, SeenPoint::kCentre}) {
    sensors::Observation z = end;
    z.seen = seen;
    EXPECT_EQ(read_otherwise(z).seen, seen);
  }
}

// Oracle: a rectangle 4 by 2 at 0.7 rad is one 2 by 4 at 0.7 rad and a quarter turn.
TEST(Reading, EveryAnchorIsTheSamePointOfTheSameRectangle) {
  const linear::Vector<2> at(20.0, -3.0), from(1.0, 2.0);
  const Box box{linear::Vector<2>(4.0, 2.0), 0.7}, other{linear::Vector<2>(2.0, 4.0), 0.7 + 0.5 * kPi};
  for (const SeenPoint seen :
       {SeenPoint::kEnd, SeenPoint::kSide, SeenPoint::kCorner, SeenPoint::kSilhouette, SeenPoint::kCentre})
    for (const signed char along : {-1, 1})
      for (const signed char across : {-1, 1}) {
        Anchor anchor{.point = seen};
        if (seen == SeenPoint::kEnd || seen == SeenPoint::kCorner) anchor.along = along;
        if (seen == SeenPoint::kSide || seen == SeenPoint::kCorner) anchor.across = across;
        if (seen == SeenPoint::kSilhouette) anchor.from = from;
        const auto centre = centre_of(anchor, at, box), otherwise = centre_of(read_otherwise(anchor), at, other);
        ASSERT_TRUE(centre && otherwise);
        EXPECT_NEAR((centre->at - otherwise->at).norm(), 0.0, 1e-12) << static_cast<int>(seen);
        EXPECT_NEAR((centre->by_box.col(0) - otherwise->by_box.col(1)).norm(), 0.0, 1e-12);
        EXPECT_TRUE(read_otherwise(read_otherwise(anchor)) == opposite(anchor));
      }
}

TEST(Reading, ASureHeadingTakesTheNearerAxisWhateverTheSize) {
  for (int degrees = 0; degrees < 180; degrees += 5) {
    if (degrees == 45 || degrees == 135) continue;
    const double off = degrees * kPi / 180.0;
    for (const double size : {0.5, 1.8, 4.4, 12.0})
      EXPECT_EQ(reads_otherwise({0.2, 0.05}, extent_of(4.4, 1.8), end_of(motion::to_half_turn(0.2 + off), size)),
                degrees > 45 && degrees < 135)
          << degrees << " degrees, " << size << " m";
  }
}

TEST(Reading, SizesDecideWhereTheHeadingIsNotSure) {
  for (const double off : {0.0, 0.4, 0.8, 1.2, 1.5}) {
    EXPECT_FALSE(reads_otherwise({0.0, 1.0}, extent_of(4.4, 1.8), end_of(off, 1.8))) << off;
    EXPECT_TRUE(reads_otherwise({0.0, 1.0}, extent_of(4.4, 1.8), end_of(off, 4.4))) << off;
  }
}

TEST(Reading, AnObservationOfNoFaceStandsAsItIs) {
  sensors::Observation centre = end_of(1.5, 4.4), silhouette = centre;
  centre.seen = SeenPoint::kCentre;
  silhouette.has_heading = false;
  EXPECT_TRUE(reads_otherwise({0.0, 0.05}, extent_of(4.4, 1.8), end_of(1.5, 4.4)));
  EXPECT_FALSE(reads_otherwise({0.0, 0.05}, extent_of(4.4, 1.8), centre));
  EXPECT_FALSE(reads_otherwise({0.0, 0.05}, extent_of(4.4, 1.8), silhouette));
}

// Four directions at 5 m/s, known to 0.1 m/s, and an object that stands.
TEST(Reading, WithoutAMeasuredAxisTheCourseIsTheAxis) {
  const config::TrackerConfig config;
  const auto estimator = estimators::make_estimator(config);
  const linear::Matrix<4> p = linear::Vector<4>(0.01, 0.01, 0.01, 0.01).asDiagonal();
  for (const double course : {0.0, 0.5 * kPi, kPi, 0.3}) {
    Body body;
    body.estimate =
        linear::Gaussian<4>{linear::Vector<4>(20.0, 3.0, 5.0 * std::cos(course), 5.0 * std::sin(course)), p};
    const Direction axis = axis_of(body, *estimator);
    EXPECT_NEAR(axis.heading, course, 1e-12);
    EXPECT_NEAR(axis.sigma, std::sqrt(0.02 * 0.02 + 0.06 * 0.06 + 0.1 * 0.1), 1e-9);
    body.heading.known = true;
    body.heading.value = 1.0;
    body.heading.variance = 0.0004;
    EXPECT_EQ(axis_of(body, *estimator).heading, 1.0);
    EXPECT_EQ(axis_of(body, *estimator).sigma, 0.02);
  }
  Body standing;
  standing.estimate = linear::Gaussian<4>{linear::Vector<4>(20.0, 3.0, 0.0, 0.0), p};
  EXPECT_GT(axis_of(standing, *estimator).sigma, 1.0);
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
