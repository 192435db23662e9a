// Scans of drawn outlines: each beam returns from the nearest line that it meets.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/random.h"
#include "sensors/laser/scan_point.h"

namespace ttf::sensors::laser {

// A line of an outline [m]. Glass lets nothing back.
struct DrawnLine {
  double x1, y1, x2, y2;
  bool glass = false;
};

// A rectangle about (x, y), with its length along the heading.
inline std::vector<DrawnLine> drawn_box(double x, double y, double heading, double length = 4.4, double width = 1.8) {
  const double c = std::cos(heading), s = std::sin(heading);
  const auto px = [&](double u, double v) { return x + c * u * length / 2 - s * v * width / 2; };
  const auto py = [&](double u, double v) { return y + s * u * length / 2 + c * v * width / 2; };
  std::vector<DrawnLine> box;
  const double u[] = {1, -1, -1, 1, 1}, v[] = {1, 1, -1, -1, 1};
  for (int k = 0; k < 4; ++k)
    box.push_back({px(u[k], v[k]), py(u[k], v[k]), px(u[k + 1], v[k + 1]), py(u[k + 1], v[k + 1])});
  return box;
}

inline std::vector<DrawnLine> drawn_circle(double x, double y, double radius) {
  std::vector<DrawnLine> circle;
  constexpr int kSides = 24;
  const auto at = [&](int k) { return 2.0 * 3.14159265358979 * k / kSides; };
  for (int k = 0; k < kSides; ++k)
    circle.push_back({x + radius * std::cos(at(k)), y + radius * std::sin(at(k)), x + radius * std::cos(at(k + 1)),
                      y + radius * std::sin(at(k + 1))});
  return circle;
}

// One layer, 0.25 degrees a beam, 60 degrees to either side; ranges have Gaussian noise of `sigma` [m], and `depth` [m] more, evenly
// drawn: leaves.
inline std::vector<ScanPoint> hand_made_scan(const std::vector<DrawnLine>& lines, std::uint64_t seed,
                                             double sigma = 0.02, double depth = 0.0) {
  std::vector<ScanPoint> scan;
  RandomStream stream({.seed = seed});
  constexpr double kBeam = 0.00436;
  for (int beam = -240; beam <= 240; ++beam) {
    const double azimuth = kBeam * beam, c = std::cos(azimuth), s = std::sin(azimuth);
    double nearest = std::numeric_limits<double>::infinity();
    bool glass = false;
    for (const DrawnLine& line : lines) {
      const double dx = line.x2 - line.x1, dy = line.y2 - line.y1, det = s * dx - c * dy;
      if (std::abs(det) < 1e-12) continue;
      const double range = (line.y1 * dx - line.x1 * dy) / det;
      const double along = (c * line.y1 - s * line.x1) / det;
      if (along < 0.0 || along > 1.0 || range <= 0.1 || range >= nearest) continue;
      nearest = range;
      glass = line.glass;
    }
    const double noise = sigma * stream.normal() + depth * static_cast<double>(stream.integer(0, 1000)) / 1000.0;
    if (std::isfinite(nearest) && !glass) scan.push_back({0, azimuth, nearest + noise});
  }
  return scan;
}

inline std::vector<DrawnLine> operator+(std::vector<DrawnLine> a, const std::vector<DrawnLine>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace ttf::sensors::laser
