#include "cli/logs/boxes_diagram.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "cli/logs/scan_verdict.h"
#include "cli/output.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "recording/rows/laser_radar_file.h"
#include "report/drawing/render.h"
#include "report/plots/boxes_picture.h"
#include "sensors/laser/preprocessor.h"

namespace ttf::cli::logs {
namespace {

std::vector<recording::rows::RecordedScan> read_scans(const std::string& path) {
  try {
    return recording::rows::read_lidar_scans(path);
  } catch (const InputError&) {
    refuse_any_kind(path, "a recording");
    throw;
  }
}

// Returns the part of a vehicle that was seen, as a box: the rest is not known. An end or a side is a line, and so is a
// corner with one known face. A silhouette is a place.
report::plots::Box box_of(const sensors::laser::LaserObject& object) {
  using ttf::fusion::sensors::SeenPoint;
  report::plots::Box box{object.x, object.y, object.heading, object.length, object.width, "", object.has_heading};
  if (object.seen != SeenPoint::kCorner) return box;
  // From the near corner away from the sensor, along both axes.
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double along = std::copysign(0.5 * object.length, c * object.x + s * object.y);
  const double across = std::copysign(0.5 * object.width, c * object.y - s * object.x);
  box.x += c * along - s * across;
  box.y += s * along + c * across;
  return box;
}

}  // namespace

int draw_boxes(const std::string& file, int frame, const report::drawing::Sheet& sheet, const std::string& out) {
  const std::vector<recording::rows::RecordedScan> scans = read_scans(file);
  if (frame >= static_cast<int>(scans.size()))
    throw InputError(
        {"command line", 0, "--frame", fmt::format("{}", frame),
         fmt::format("must be 0..{}: the recording has {}", scans.size() - 1, counted(scans.size(), "scan"))});
  const recording::rows::RecordedScan& scan = scans[static_cast<std::size_t>(frame)];
  std::vector<sensors::laser::ScanPoint> points;
  std::vector<report::drawing::Point> drawn;
  for (const recording::rows::RecordedReturn& hit : scan.returns) {
    points.push_back({0, hit.azimuth_rad, hit.range_m});
    drawn.push_back({hit.range_m * std::cos(hit.azimuth_rad), hit.range_m * std::sin(hit.azimuth_rad)});
  }
  std::vector<sensors::laser::LaserObject> objects;
  const sensors::laser::LaserPreprocessingConfig config;
  sensors::laser::LaserPreprocessor preprocessor(config, points.size());
  preprocessor.process(points, objects);
  std::vector<report::plots::Box> rectangles;
  for (const sensors::laser::LaserObject& object : objects) rectangles.push_back(box_of(object));
  const std::string title = fmt::format("Scan {}: {}, {} box{}", scan.frame, counted(points.size(), "return"),
                                        objects.size(), objects.size() == 1 ? "" : "es");
  report::drawing::write_picture(report::plots::boxes_svg(drawn, rectangles, title, "fitted box", sheet), out);
  say_written(out);
  return print_reasons(file, title, reasons_for_no_box(config, preprocessor.fates()));
}

}  // namespace ttf::cli::logs
