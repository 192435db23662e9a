#include "sensors/laser/rectangle_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sensors/laser/outline_fit.h"
#include "sensors/laser/range_models.h"

namespace ttf::sensors::laser {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using ttf::fusion::sensors::SeenPoint;

// A face may be taken for a corner with this probability.
constexpr double kFalseCorner = 0.01;
// The smallest variance: the bus has sigmas in millimetres.
constexpr double kSquareMillimetre_m2 = 1e-6;
// Segmentation compares the farthest return of a beam with the nearest of the next one. They differ by so many standard
// deviations of the range, at most.
constexpr double kOfNoise = 4.0;

Vector2d quarter_on(const Vector2d& a) { return {-a.y(), a.x()}; }

int beams_of(std::span<const PlanePoint> points) {
  int beams = 1;
  for (std::size_t i = 1; i < points.size(); ++i) beams += points[i].azimuth != points[i - 1].azimuth;
  return beams;
}

// Where a face ends: between the last beam and the next one, `gap` apart on the face.
struct FaceEnd {
  Vector2d middle;
  double gap;
  double azimuth;  // midway
  bool known;      // otherwise the face reaches at least to the last beam
};

FaceEnd face_end(const Vector2d& n, double distance, double sigma_normal, double noise, double last, double step,
                 const OutlineEnd& end) {
  const Vector2d u = direction(last), next = direction(last + step);
  const Vector2d at = u * (distance / std::max(kFlattestBeam, n.dot(u)));
  if (n.dot(next) < kFlattestBeam) return {at, 0.0, last, false};
  const Vector2d beyond = next * (distance / n.dot(next));
  const double gap = (beyond - at).norm();
  if (end.hidden || gap * (1.0 + 2.0 * sigma_normal / n.dot(next)) + kOfNoise * noise > end.held_gap_m)
    return {at, 0.0, last, false};
  return {0.5 * (at + beyond), gap, last + 0.5 * step, true};
}

void set_covariance(LaserObject& object, const Matrix2d& covariance) {
  object.sxx = covariance(0, 0) + kSquareMillimetre_m2;
  object.sxy = covariance(0, 1);
  object.syy = covariance(1, 1) + kSquareMillimetre_m2;
}

// The outline's mean distance, in the middle of its span of bearings. The span ends within a step beyond its outermost
// beams.
LaserObject silhouette(const RectangleConfig& config, std::span<const PlanePoint> points) {
  const double step = config.azimuth_step_rad;
  const auto first_of_beam = [&](std::size_t i) { return i == 0 || points[i].azimuth != points[i - 1].azimuth; };
  double sum = 0.0, beams = 0.0, beam_sum = 0.0, in_beam = 0.0, of_first = 0.0, of_last = 0.0;
  for (std::size_t i = 0; i <= points.size(); ++i) {
    if (i == points.size() || first_of_beam(i)) {
      if (i > 0) {
        of_last = beam_sum / in_beam;
        if (beams == 0.0) of_first = of_last;
        sum += of_last;
        beams += 1.0;
      }
      beam_sum = in_beam = 0.0;
    }
    if (i < points.size()) {
      beam_sum += points[i].range;
      in_beam += 1.0;
    }
  }
  const double range = sum / beams, from = points.front().azimuth, to = points.back().azimuth;
  const Vector2d u = direction(0.5 * (from + to)), across = quarter_on(u);
  LaserObject object;
  object.x = range * u.x();
  object.y = range * u.y();
  const double uniform = step * step / 12.0, span = to - from + step;
  Matrix2d covariance =
      u * u.transpose() * (config.range_noise_m * config.range_noise_m / static_cast<double>(points.size()));
  const auto add_end = [&](double side, double end_range) {
    // For an end that is one radian further out: -1 for the first beam's, at the smallest azimuth.
    const Vector2d shift = side * 0.5 * range * across + (end_range - range) / span * u;
    covariance += shift * shift.transpose() * uniform;
  };
  add_end(-1.0, of_first);
  add_end(1.0, of_last);
  set_covariance(object, covariance);
  return object;
}

struct Size {
  double value = 0.0, sigma = 0.0;
  double margin = 0.0;  // [m], without noise the true size differs by at most this
  bool known = false;
};

void set_length(LaserObject& object, const Size& size) {
  object.has_length = true;
  object.length = size.value;
  object.sigma_length = size.sigma;
}
void set_width(LaserObject& object, const Size& size) {
  object.has_width = true;
  object.width = size.value;
  object.sigma_width = size.sigma;
}
void set_heading(LaserObject& object, const Vector2d& axis, double variance) {
  object.has_heading = true;
  object.heading = std::atan2(axis.y(), axis.x());
  object.sigma_heading = std::sqrt(variance);
}

bool is_a_width(const RectangleConfig& config, const Size& size) {
  return size.known && size.value > config.narrowest_width_m && size.value < config.widest_rear_m;
}

bool surely_a_width(const RectangleConfig& config, const Size& size) {
  return size.known && size.value - size.margin > config.narrowest_width_m &&
         size.value + size.margin < config.widest_rear_m;
}

// The corner where a face ends. The field cuts the other end of the outline. `into` is the direction into the face.
struct SeenEnd {
  FaceEnd end;
  Matrix2d covariance;
  Vector2d into;
};
std::optional<LaserObject> outermost(const OutlineEnds& ends, const SeenEnd& right, const SeenEnd& left) {
  const bool by_right = right.end.known && ends[1].by_field;
  if (!by_right && !(left.end.known && ends[0].by_field)) return std::nullopt;
  const SeenEnd& seen = by_right ? right : left;
  LaserObject object;
  object.seen = by_right ? SeenPoint::kRightmost : SeenPoint::kLeftmost;
  object.x = seen.end.middle.x();
  object.y = seen.end.middle.y();
  set_covariance(object, seen.covariance);
  object.heading = std::atan2(seen.into.y(), seen.into.x());
  return object;
}

// One face is a side or an end. Both of its ends must be known, and the face must be as long as one of these. Else one of its ends is
// stated, if that is known.
std::optional<LaserObject> single_face(const RectangleConfig& config, std::span<const PlanePoint> points,
                                       const OutlineEnds& ends, const FaceFit& fit) {
  const Vector2d n = direction(fit.normal), t = quarter_on(n);
  const double step = config.azimuth_step_rad;
  const Matrix2d& errors = fit.covariance;
  const double sigma_normal = std::sqrt(errors(1, 1));
  const FaceEnd right =
      face_end(n, fit.distance, sigma_normal, config.range_noise_m, points.front().azimuth, -step, ends[0]);
  const FaceEnd left =
      face_end(n, fit.distance, sigma_normal, config.range_noise_m, points.back().azimuth, step, ends[1]);
  Matrix2d point = Matrix2d::Zero();  // by distance and normal
  Vector2d extent = Vector2d::Zero();
  std::array<Matrix2d, 2> of_end;  // covariances
  for (const FaceEnd* end : {&right, &left}) {
    const Vector2d u = direction(end->azimuth);
    const double steep = n.dot(u), along = end == &left ? 1.0 : -1.0;
    const double per_normal = -fit.distance * cross(n, u) / (steep * steep);
    point.col(0) += 0.5 * u / steep;
    point.col(1) += 0.5 * u * per_normal;
    extent(0) += along * t.dot(u) / steep;
    extent(1) += along * -fit.distance / (steep * steep);
    Matrix2d by;
    by << u / steep, u * per_normal;
    of_end[end == &left] = by * errors * by.transpose() + t * t.transpose() * (end->gap * end->gap / 12.0);
  }
  if (!right.known || !left.known) return outermost(ends, {right, of_end[0], n}, {left, of_end[1], n});
  const double spread = (right.gap * right.gap + left.gap * left.gap) / 12.0;
  const Size size{t.dot(left.middle - right.middle), std::sqrt(extent.dot(errors * extent) + spread),
                  0.5 * (left.gap + right.gap), true};
  LaserObject object;
  const Vector2d middle = 0.5 * (left.middle + right.middle);
  object.x = middle.x();
  object.y = middle.y();
  set_covariance(object, point * errors * point.transpose() + t * t.transpose() * (0.25 * spread));
  if (size.value - size.margin > config.widest_rear_m) {
    object.seen = SeenPoint::kSide;
    set_heading(object, t, errors(1, 1));
    set_length(object, size);
  } else if (is_a_width(config, size) && size.value + size.margin < config.widest_rear_m) {
    object.seen = SeenPoint::kEnd;
    set_heading(object, n, errors(1, 1));
    set_width(object, size);
  } else {
    return std::nullopt;
  }
  return object;
}

// A face of a corner, and its end away from the corner.
struct CornerFace {
  Size size;
  SeenEnd end;
};

// Two faces are a corner. It must be known which of them is the side. Else the end of one of them is stated.
std::optional<LaserObject> two_faces(const RectangleConfig& config, std::span<const PlanePoint> points,
                                     const OutlineEnds& ends, const CornerFit& fit) {
  const Vector2d right_normal = direction(fit.normal), left_normal(right_normal.y(), -right_normal.x());
  const Eigen::Matrix3d& errors = fit.covariance;
  const double sigma_normal = std::sqrt(errors(2, 2));
  const auto face_of = [&](bool left) {
    const Vector2d& n = left ? left_normal : right_normal;
    const Vector2d& t = left ? right_normal : left_normal;  // along this face, away from the corner
    const double step = config.azimuth_step_rad;
    const FaceEnd end =
        left ? face_end(n, n.dot(fit.corner), sigma_normal, config.range_noise_m, points.back().azimuth, step, ends[1])
             : face_end(n, n.dot(fit.corner), sigma_normal, config.range_noise_m, points.front().azimuth, -step,
                        ends[0]);
    const Vector2d u = direction(end.azimuth);
    const double sine = cross(t, u);
    const Vector3d by(-u.y() / sine, u.x() / sine, -cross(fit.corner, u) * t.dot(u) / (sine * sine));
    const double spread = end.gap * end.gap / 12.0;
    const Size size{t.dot(end.middle - fit.corner), std::sqrt(by.dot(errors * by) + spread), 0.5 * end.gap, end.known};
    // The end is the corner + size t; t turns with the normal.
    Eigen::Matrix<double, 2, 3> by_fit = t * by.transpose();
    by_fit.leftCols<2>() += Matrix2d::Identity();
    by_fit.col(2) += size.value * quarter_on(t);
    return CornerFace{size, {end, by_fit * errors * by_fit.transpose() + t * t.transpose() * spread, n}};
  };
  const CornerFace right_face = face_of(false), left_face = face_of(true);
  const Size &right = right_face.size, &left = left_face.size;
  // A side is longer than any width, even if its end is not known. If no face is, one of a whole width is the end.
  const double longer = std::max(right.value - right.margin, left.value - left.margin);
  bool left_is_side;
  if (longer > config.widest_rear_m)
    left_is_side = left.value - left.margin > right.value - right.margin;
  else if (surely_a_width(config, right) != surely_a_width(config, left))
    left_is_side = surely_a_width(config, right);
  else
    return outermost(ends, right_face.end, left_face.end);
  const Size& side = left_is_side ? left : right;
  const Size& end = left_is_side ? right : left;
  LaserObject object;
  object.seen = SeenPoint::kCorner;
  object.x = fit.corner.x();
  object.y = fit.corner.y();
  set_covariance(object, errors.topLeftCorner<2, 2>());
  set_heading(object, left_is_side ? right_normal : left_normal, errors(2, 2));
  if (side.known && side.value > config.widest_rear_m) set_length(object, side);
  if (is_a_width(config, end)) set_width(object, end);
  return object;
}

}  // namespace

LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points, const OutlineEnds& ends) {
  const int beams = beams_of(points);
  const double noise = config.range_noise_m;
  const auto face = beams >= 2 && points.size() > 2 ? fit_face(points, noise) : std::nullopt;
  const auto corner =
      beams >= 3 && points.size() > 3 ? fit_corner(points, noise, config.azimuth_step_rad, face) : std::nullopt;
  const double threshold = 2.0 * std::log(beams / (2.0 * kFalseCorner));
  std::optional<LaserObject> object;
  double squares = 0.0, freedom = static_cast<double>(points.size());
  if (corner && (!face || face->squares - corner->squares > threshold * corner->variance)) {
    object = two_faces(config, points, ends, *corner);
    squares = corner->squares;
    freedom -= CornerModel::kSize;
  } else if (face) {
    object = single_face(config, points, ends, *face);
    squares = face->squares;
    freedom -= FaceModel::kSize;
  }
  if (!object) object = silhouette(config, points);
  object->points = static_cast<int>(points.size());
  object->residual_m = std::sqrt(squares / std::max(1.0, freedom));
  return *object;
}

}  // namespace ttf::sensors::laser
