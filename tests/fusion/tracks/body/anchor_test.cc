// Points of a box as sensors see them, against rays and numeric derivatives.
#include "fusion/tracks/body/anchor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;
using V = linear::Vector<2>;
constexpr double kPi = std::numbers::pi;

V unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Range of the box along a ray from the origin; infinite where it misses.
double ray(const V& centre, const Box& box, double azimuth) {
  double enters = 0.0, leaves = std::numeric_limits<double>::infinity();
  const V axes[] = {unit(box.heading), unit(box.heading + kPi / 2)};
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double along = unit(azimuth).dot(axes[k]), middle = centre.dot(axes[k]), half = 0.5 * box.size(k);
    double a = (middle - half) / along, b = (middle + half) / along;
    if (a > b) std::swap(a, b);
    enters = std::max(enters, a);
    leaves = std::min(leaves, b);
  }
  return enters < leaves ? enters : std::numeric_limits<double>::infinity();
}

// The silhouette by 20,000 rays, seen from the origin.
struct ByRays {
  V point;
  double span;
};
ByRays by_rays(const V& centre, const Box& box) {
  const double middle = std::atan2(centre.y(), centre.x());
  double low = 0.0, high = 0.0;
  for (const double a : {0.5, -0.5})
    for (const double b : {0.5, -0.5}) {
      const V corner = centre + a * box.size(0) * unit(box.heading) + b * box.size(1) * unit(box.heading + kPi / 2);
      const double off = std::remainder(std::atan2(corner.y(), corner.x()) - middle, 2 * kPi);
      low = std::min(low, off);
      high = std::max(high, off);
    }
  constexpr int kRays = 20000;
  double sum = 0.0;
  for (int k = 0; k < kRays; ++k) sum += ray(centre, box, middle + low + (k + 0.5) / kRays * (high - low));
  return {sum / kRays * unit(middle + 0.5 * (low + high)), high - low};
}

TEST(Silhouette, IsWhatRaysSee) {
  for (const V& centre : {V(12.0, 2.0), V(30.0, -9.0), V(-5.0, 25.0), V(60.0, 0.0)})
    for (int k = 0; k < 24; ++k) {
      const Box box{{4.4, 1.8}, 0.05 + k * kPi / 12};
      const std::optional<Silhouette> seen = silhouette_of(centre, box);
      ASSERT_TRUE(seen);
      const ByRays rays = by_rays(centre, box);
      EXPECT_NEAR((seen->point.at - rays.point).norm(), 0.0, 1e-3) << "heading " << box.heading;
      EXPECT_NEAR(seen->span, rays.span, 1e-12);
    }
}

TEST(Silhouette, IsNoneAroundTheSensor) { EXPECT_FALSE(silhouette_of({1.0, 0.5}, {{4.4, 1.8}, 0.0})); }

TEST(Anchor, NamesTheNearEndAndSide) {
  const auto at = [](SeenPoint point, double heading) { return anchor_of(point, {20.0, 5.0}, heading, {1.0, 0.0}); };
  EXPECT_EQ(at(SeenPoint::kEnd, 0.0).along, -1) << "a car ahead that drives on shows its rear";
  EXPECT_EQ(at(SeenPoint::kEnd, kPi).along, 1) << "an oncoming one its front";
  EXPECT_EQ(at(SeenPoint::kSide, 0.0).across, -1) << "on the left, its right side";
  EXPECT_EQ(at(SeenPoint::kSide, kPi).across, 1);
  EXPECT_EQ(at(SeenPoint::kSide, 0.0).along, 0);
  EXPECT_EQ(at(SeenPoint::kCorner, kPi / 2).along, -1);
  EXPECT_EQ(at(SeenPoint::kCorner, kPi / 2).across, 1);
  EXPECT_EQ(at(SeenPoint::kSilhouette, 0.3).from, V(1.0, 0.0));
  EXPECT_EQ(at(SeenPoint::kCentre, 0.3), Anchor{});
}

Anchor anchors[] = {{},
                    {SeenPoint::kEnd, -1, 0},
                    {SeenPoint::kSide, 0, 1},
                    {SeenPoint::kCorner, -1, 1},
                    {.point = SeenPoint::kSilhouette, .from = {1.0, 0.5}}};

TEST(Anchor, CentreAndPointUndoEachOther) {
  for (const Anchor& anchor : anchors)
    for (int k = 0; k < 16; ++k) {
      const Box box{{4.7, 1.7}, 0.1 + k * kPi / 8};
      const V centre(25.0, 6.0);
      const std::optional<Located> point = point_of(anchor, {}, centre, box);
      ASSERT_TRUE(point);
      const std::optional<Located> back = centre_of(anchor, point->at, box);
      ASSERT_TRUE(back);
      EXPECT_NEAR((back->at - centre).norm(), 0.0, 1e-4);
    }
}

TEST(Anchor, OfARearIsHalfALengthBehindTheCentre) {
  const std::optional<Located> rear = point_of({SeenPoint::kEnd, -1, 0}, {}, {10.0, 3.0}, {{4.0, 1.8}, kPi / 2});
  ASSERT_TRUE(rear);
  EXPECT_NEAR((rear->at - V(10.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((rear->by_box.col(0) - V(0.0, -0.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(rear->by_box.col(1).norm(), 0.0, 1e-12);
  EXPECT_NEAR((rear->by_box.col(2) - V(2.0, 0.0)).norm(), 0.0, 1e-12);
}

TEST(Anchor, DerivativesAreTheNumericOnes) {
  for (const Anchor& own : anchors)
    for (const Anchor& other : anchors)
      for (int k = 0; k < 8; ++k) {
        const Box box{{4.4, 1.8}, 0.2 + k * kPi / 4};
        const V at(25.0, 6.0);
        const std::optional<Located> point = point_of(other, own, at, box);
        ASSERT_TRUE(point);
        for (Eigen::Index d = 0; d < 3; ++d) {
          const double h = 1e-5;
          Box up = box, down = box;
          (d < 2 ? up.size(d) : up.heading) += h;
          (d < 2 ? down.size(d) : down.heading) -= h;
          const V numeric = (point_of(other, own, at, up)->at - point_of(other, own, at, down)->at) / (2 * h);
          EXPECT_NEAR((point->by_box.col(d) - numeric).norm(), 0.0, 2e-3) << "of derivative " << d;
        }
      }
}

// Each face of boxes about the origin in all directions: its ends, as a sensor in front of it sees them.
TEST(Outermost, IsTheEndOfTheFaceInView) {
  for (int k = 0; k < 24; ++k) {
    const double heading = 0.05 + k * kPi / 12;
    const V along = unit(heading), across = unit(heading + kPi / 2);
    for (const V& outwards : {along, V(-along), across, V(-across)}) {
      const V into = -outwards, right(into.y(), -into.x());
      // Known up to half a quarter turn: the face is still the same.
      for (const double error : {-0.7, 0.0, 0.7}) {
        const double into_face = std::atan2(into.y(), into.x()) + error;
        for (const SeenPoint point : {SeenPoint::kRightmost, SeenPoint::kLeftmost}) {
          const V side = point == SeenPoint::kRightmost ? right : V(-right);
          const std::optional<Anchor> found = outermost_of(point, into_face, along, outwards + side, 20.0 * outwards);
          ASSERT_TRUE(found) << heading << " " << error;
          const Anchor corner = *found;
          EXPECT_EQ(corner.point, SeenPoint::kCorner);
          const V at = corner.along * along + corner.across * across;
          EXPECT_NEAR((at - outwards - side).norm(), 0.0, 1e-12) << heading << " " << error;
        }
      }
    }
  }
}

// From beyond the corner the face beside it comes into view, and would end the outline at its far corner.
TEST(Outermost, IsVagueWhereTheNextFaceIsInView) {
  const V along = unit(0.0);
  const V corner(-1.0, -1.0);
  EXPECT_TRUE(outermost_of(SeenPoint::kRightmost, 0.0, along, corner, {-20.0, -0.5}));
  EXPECT_FALSE(outermost_of(SeenPoint::kRightmost, 0.0, along, corner, {-20.0, -1.5}));
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
