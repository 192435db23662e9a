#include "cli/track/scan_picture.h"

#include <fmt/format.h>

#include <cmath>

#include "core/counted.h"

namespace ttf::cli::track {
namespace {

// A heading is drawn if it is known as well as this: 20 degrees.
constexpr double kKnownHeading_rad = 0.35;

}  // namespace

ScanPicture::ScanPicture(const recording::rows::RecordedScan& scan, const sensors::laser::RecordedScansConfig& how)
    : scan_(scan), at_(sensors::laser::instant_of(scan, how)) {}

// A mounted scanner's returns are in its own axes, tracks in the vehicle's: the picture is of a scanner at the origin.
void ScanPicture::take(std::span<const fusion::tracks::TrackView> tracks) {
  if (tracks.empty() || tracks.front().valid_at != at_) return;
  boxes_.clear();
  for (const fusion::tracks::TrackView& track : tracks)
    boxes_.push_back({track.state(0), track.state(1), track.heading, track.length, track.width,
                      std::to_string(index_of(track.id)), track.sigma_heading <= kKnownHeading_rad,
                      track.has_length && track.has_width});
}

std::string ScanPicture::svg(const report::drawing::Sheet& sheet) const {
  std::vector<report::drawing::Point> points;
  for (const recording::rows::RecordedReturn& hit : scan_.returns)
    points.push_back({hit.range_m * std::cos(hit.azimuth_rad), hit.range_m * std::sin(hit.azimuth_rad)});
  return report::plots::boxes_svg(
      points, boxes_,
      fmt::format("Scan {}: {}, {}", scan_.frame, counted(points.size(), "return"), counted(boxes_.size(), "track")),
      "track", sheet);
}

}  // namespace ttf::cli::track
