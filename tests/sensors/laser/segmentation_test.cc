#include "sensors/laser/segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/sensors/laser/emulated_scan.h"

namespace ttf::sensors::laser {
namespace {

struct Cut {
  std::vector<PlanePoint> points;
  std::vector<Segment> segments;
};
Cut cut(const std::vector<ScanPoint>& scan) {
  Cut c;
  segment_scan(SegmentationConfig{}, scan, c.points, c.segments);
  std::size_t next = 0;
  for (const Segment& segment : c.segments) {
    EXPECT_EQ(segment.first, next) << "segments do not follow each other";
    EXPECT_GT(segment.count, 0U);
    next += segment.count;
  }
  EXPECT_EQ(next, scan.size()) << "a return belongs to no segment";
  return c;
}

TEST(Segmentation, AnEmptyScanHasNone) { EXPECT_TRUE(cut({}).segments.empty()); }

TEST(Segmentation, OneReturnIsOneSegment) {
  const Cut c = cut({{2, std::numbers::pi / 6, 10.0}});
  ASSERT_EQ(c.segments.size(), 1U);
  EXPECT_NEAR(c.points[0].x, 8.660254, 1e-6);
  EXPECT_NEAR(c.points[0].y, 5.0, 1e-12);
}

TEST(Segmentation, CarsBesideEachOtherAreTwo) {
  for (const double range : {12.0, 30.0, 60.0}) {
    // 2.2 m apart, turned to the sensor so that only their rears show.
    const double turn = std::atan2(2.0, range);
    const auto scan = emulated_scan({}, {car_at(range, -2.0, -turn), car_at(range, 2.0, turn, 4.4, 1.8, 1)}, 0);
    EXPECT_EQ(cut(scan).segments.size(), 2U) << range;
  }
}

TEST(Segmentation, ACarInFrontOfAnotherIsCutFromIt) {
  // The far one shows to the left of the near one, 13 m behind it.
  const auto scan = emulated_scan({}, {car_at(12.0, 0.0, 0.0), car_at(30.0, 3.0, 0.0, 4.4, 1.8, 1)}, 0);
  EXPECT_EQ(cut(scan).segments.size(), 2U);
}

TEST(Segmentation, AFlatlySeenWallHoldsTogether) {
  // A wall along x, 5 m to the left: at 20 m it is seen under 14 degrees, and neighbours are up to 0.4 m
  // apart.
  std::vector<ScanPoint> scan;
  for (int k = 0; k < 200; ++k) {
    const double azimuth = std::atan2(5.0, 20.0) + 0.00436 * k;
    scan.push_back({0, azimuth, 5.0 / std::sin(azimuth)});
  }
  EXPECT_EQ(cut(scan).segments.size(), 1U);
}

TEST(Segmentation, AMissingBeamOrTwoDoNotCut) {
  auto scan = emulated_scan({}, {car_at(20.0, 0.0, 0.0)}, 0);
  const double hole = scan[scan.size() / 2].azimuth;
  std::erase_if(scan, [&](const ScanPoint& p) { return p.azimuth >= hole && p.azimuth < hole + 0.0080; });
  EXPECT_EQ(cut(scan).segments.size(), 1U);
}

TEST(Segmentation, TheOrderOfTheListDoesNotMatter) {
  auto scan = emulated_scan({}, {car_at(20.0, -4.0, 0.4), car_at(25.0, 4.0, 1.0, 4.4, 1.8, 1)}, 3);
  const Cut forwards = cut(scan);
  std::reverse(scan.begin(), scan.end());
  const Cut backwards = cut(scan);
  ASSERT_EQ(forwards.segments.size(), backwards.segments.size());
  for (std::size_t i = 0; i < forwards.points.size(); ++i) {
    EXPECT_EQ(forwards.points[i].x, backwards.points[i].x);
    EXPECT_EQ(forwards.points[i].y, backwards.points[i].y);
  }
}

}  // namespace
}  // namespace ttf::sensors::laser
