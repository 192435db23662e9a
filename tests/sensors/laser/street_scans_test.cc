// A real scanner in a real street (the recording is not part of the repository). Without ground truth, boxes
// must be plausible as vehicles and hold still from scan to scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "recording/rows/laser_radar_file.h"
#include "sensors/laser/preprocessor.h"
#include "tests/support/recordings.h"

namespace ttf::sensors::laser {
namespace {

constexpr const char* kRecording = "lidar_scans/scans.csv";

std::vector<std::vector<ScanPoint>> street_scans() {
  const std::string path = support::recording_path(kRecording);
  std::vector<std::vector<ScanPoint>> scans;
  if (!std::filesystem::exists(path)) return scans;
  for (const recording::rows::RecordedScan& recorded : recording::rows::read_lidar_scans(path)) {
    std::vector<ScanPoint>& scan = scans.emplace_back();
    for (const recording::rows::RecordedReturn& hit : recorded.returns)
      scan.push_back({0, hit.azimuth_rad, hit.range_m});
  }
  return scans;
}

// Ten scans a second in a city with a limit of 50 km/h: an object moves at most 1.4 m, and a little.
constexpr double kMostStep_m = 1.5;

TEST(StreetScans, YieldPlausibleVehicles) {
  const auto scans = street_scans();
  if (scans.empty()) GTEST_SKIP() << support::recording_missing(kRecording);
  ASSERT_EQ(scans.size(), 22U);
  std::size_t most_points = 0;
  for (const auto& scan : scans) most_points = std::max(most_points, scan.size());
  LaserPreprocessor preprocessor({}, most_points);
  std::vector<LaserObject> objects, last;
  std::size_t steady = 0, compared = 0;
  for (const auto& scan : scans) {
    preprocessor.process(scan, objects);
    std::size_t vehicles = 0;
    for (const LaserObject& o : objects) {
      EXPECT_TRUE(std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.heading));
      EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
      EXPECT_GE(o.points, 3);
      EXPECT_LE(o.length, LaserPreprocessingConfig{}.longest_extent_m + 0.5);
      if (o.has_width) {
        EXPECT_LT(o.width, 2.7);
      }
      const bool vehicle = o.has_length && o.length > 3.0 && o.length < 6.5;
      vehicles += vehicle;
      if (vehicle && !last.empty() && std::hypot(o.x, o.y) < 30.0) {
        ++compared;
        steady += std::any_of(last.begin(), last.end(),
                              [&](const LaserObject& p) { return std::hypot(p.x - o.x, p.y - o.y) < kMostStep_m; });
      }
    }
    EXPECT_GE(objects.size(), 5U);
    EXPECT_LE(objects.size(), 60U);
    EXPECT_GE(vehicles, 1U);
    last = objects;
  }
  ASSERT_GT(compared, 20U);
  EXPECT_GT(static_cast<double>(steady), 0.8 * static_cast<double>(compared));
}

}  // namespace
}  // namespace ttf::sensors::laser
