#include "sensors/mono_camera/ground_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/config/classes.h"

namespace ttf::sensors::mono_camera {
namespace {

double squared(double a) { return a * a; }

// How an object of this turn shows itself, along the line of sight through the middle of its silhouette.
struct Shown {
  double span = 0.0, span_variance = 0.0;  // [rad], and by the size
  double behind = 0.0;                     // [m], from the point of least depth to the mean distance of the outline
};

// With the nearest corner `range` away. Both faces in view run from it: the side to (L |c|, +-L |s|), the end to
// (W |s|, -+W |c|), along and across the line of sight.
Shown shown_by(const ttf::fusion::config::Sizes& size, double c, double s, double range, double bearing) {
  const double side = s < 0.0 ? -1.0 : 1.0, along = std::abs(c), across = std::abs(s);
  const double x1 = size.length * along, y1 = size.length * across, x2 = size.width * across, y2 = size.width * along;
  const double by_length = y1 / (range + x1), by_width = y2 / (range + x2);
  Shown shown;
  shown.span = by_length + by_width;
  shown.span_variance =
      squared(across / (range + x1) * size.length_sigma) + squared(along / (range + x2) * size.width_sigma);
  const double mean = 0.5 * (by_length * x1 + by_width * x2) / shown.span;
  // The nearest corner lies beside the middle, so that a turned optical axis finds another corner less deep.
  const double middle = 0.5 * side * (by_length - by_width) * range, tangent = std::tan(bearing);
  const double least =
      std::min({middle * tangent, x1 - (side * y1 - middle) * tangent, x2 + (side * y2 + middle) * tangent});
  shown.behind = mean - least;
  return shown;
}

}  // namespace

MonoCalibration load_mono_calibration(YamlMap& yaml) {
  MonoCalibration c;
  c.height_m = yaml.number_or("height", c.height_m, {0.2, 100.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.pitch_rad = yaml.number_or("pitch", c.pitch_rad, {-0.05, 0.05}, "rad");
  c.pitch_sigma_rad = yaml.number_or("pitch_sigma", c.pitch_sigma_rad, {0.0, 0.02}, "rad");
  c.column_sigma_px = yaml.number_or("column_sigma", c.column_sigma_px, {0.01, 100.0}, "px");
  c.row_sigma_px = yaml.number_or("row_sigma", c.row_sigma_px, {0.01, 100.0}, "px");
  if (auto marks = yaml.map_if("marks")) {
    c.marks = load_mark_calibration(*marks);
    marks->finish();
  }
  return c;
}

GroundPlane::GroundPlane(const MonoCalibration& calibration) : k_(calibration) {
  for (std::size_t k = 0; k < kTurns; ++k) {
    const double angle = (static_cast<double>(k) + 0.5) / kTurns * std::numbers::pi - 0.5 * std::numbers::pi;
    turns_[k] = {std::cos(angle), std::sin(angle)};
  }
}

CameraObject GroundPlane::locate(const PictureBox& box) const {
  const double f = k_.focal_px, h = k_.height_m;
  const double down = std::max(k_.pitch_rad + std::atan(box.bottom / f), 0.5 * k_.row_sigma_px / f);
  const double depth = h / std::tan(down);
  const double by_angle = (squared(depth) + squared(h)) / h, by_row = by_angle * f / (squared(f) + squared(box.bottom));

  const double low = -std::atan(box.right / f), high = -std::atan(box.left / f), bearing = 0.5 * (low + high);
  const double by_left = f / (squared(f) + squared(box.left)), by_right = f / (squared(f) + squared(box.right));
  CameraObject object;
  object.class_code = box.class_code;
  object.span = high - low;
  object.sigma_span = k_.column_sigma_px * std::hypot(by_left, by_right);

  const double c = std::cos(bearing), s = std::sin(bearing), range = depth / c;
  const double along = (squared(by_row * k_.row_sigma_px) + squared(by_angle * k_.pitch_sigma_rad)) / squared(c);
  const auto code = static_cast<std::size_t>(box.class_code);
  const ttf::fusion::config::Sizes& usual =
      ttf::fusion::config::kClassPriors[code < ttf::fusion::config::kClassCount ? code : 0].sizes;
  double sum = 0.0, mean = 0.0, squares = 0.0;
  for (const Turn& turn : turns_) {
    const Shown shown = shown_by(usual, turn.c, turn.s, range, bearing);
    const double variance = squared(object.sigma_span) + shown.span_variance + squared(shown.span / range) * along;
    const double weight = std::exp(-0.5 * squared(object.span - shown.span) / variance) / std::sqrt(variance);
    sum += weight;
    mean += weight * shown.behind;
    squares += weight * squared(shown.behind);
  }
  // No heading fits a box of another class, or of nothing: anything from the nearest point to half a length.
  constexpr double kFits = 1e-9;
  double behind = 0.25 * usual.length, spread = squared(behind) / 3.0;
  if (sum > kFits) {
    behind = mean / sum;
    spread = std::max(0.0, squares / sum - squared(behind));
  }
  const double distance = range + behind;
  object.x = distance * c;
  object.y = distance * s;
  object.set_errors(c, s, along + spread, squared(0.5 * distance * object.sigma_span));
  return object;
}

}  // namespace ttf::sensors::mono_camera
