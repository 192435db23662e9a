// Ranges that beams measure at a face or at a corner, and the least squares of their errors (outline_fit.h).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

// No beam is taken to be more parallel to its face than this (sine).
inline constexpr double kFlattestBeam = 1e-3;

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
inline Eigen::Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

// A model has parameters in kSize dimensions; at() gives the range in a direction, and its derivatives.
struct FaceModel {
  static constexpr int kSize = 2;
  double distance;
  Eigen::Vector2d n;
  explicit FaceModel(const Eigen::Vector2d& p) : distance(p(0)), n(direction(p(1))) {}
  bool usable() const { return distance > 0.0; }
  double at(const Eigen::Vector2d& u, std::size_t, Eigen::Vector2d& derivatives) const {
    const double steep = std::max(kFlattestBeam, n.dot(u)), range = distance / steep;
    derivatives << 1.0 / steep, -range * cross(n, u) / steep;  // dn/dangle . u = cross(n, u)
    return range;
  }
};

// The first `returns_right` returns are of the right face; or those to the right of the corner are.
inline constexpr std::size_t kByBearing = std::numeric_limits<std::size_t>::max();
struct CornerModel {
  static constexpr int kSize = 3;
  std::size_t returns_right;
  Eigen::Vector2d corner, right, left;
  CornerModel(const Eigen::Vector3d& p, std::size_t of_right = kByBearing)
      : returns_right(of_right), corner(p(0), p(1)), right(direction(p(2))), left(right.y(), -right.x()) {}
  // Both faces are turned to the sensor.
  bool usable() const { return right.dot(corner) > 0.0 && left.dot(corner) > 0.0; }
  double at(const Eigen::Vector2d& u, std::size_t index, Eigen::Vector3d& derivatives) const {
    const bool of_right = returns_right == kByBearing ? cross(corner, u) <= 0.0 : index < returns_right;
    const Eigen::Vector2d& n = of_right ? right : left;
    const double steep = std::max(kFlattestBeam, n.dot(u)), distance = n.dot(corner), range = distance / steep;
    derivatives << n.x() / steep, n.y() / steep, (cross(n, corner) - range * cross(n, u)) / steep;
    return range;
  }
};

// Returns the variance of a range. The noise has it, or more where the fit certainly leaves more. A real outline has
// wheels and windows.
inline double variance_of(double squares, std::size_t returns, int parameters, double noise) {
  constexpr double kCertain = 4.0;  // standard deviations
  const double freedom = static_cast<double>(returns) - parameters;
  if (freedom < 1.0) return noise * noise;
  const double excess = squares / (freedom * noise * noise);
  return noise * noise * (excess > 1.0 + kCertain * std::sqrt(2.0 / freedom) ? excess : 1.0);
}

template <int kSize> using Vector = Eigen::Matrix<double, kSize, 1>;

// Minimises the squares of the range errors from `p` on. Returns their sum, or nothing.
template <class Model, class... Rest>
std::optional<double> minimise(std::span<const PlanePoint> points, Vector<Model::kSize>& p,
                               Eigen::Matrix<double, Model::kSize, Model::kSize>& covariance, Rest... rest) {
  constexpr int kMostSteps = 12, kMostHalvings = 6;
  // A step this far below any noise (squared, in metres and radians) ends it.
  constexpr double kSmallestStep2 = 1e-14, kSingular = 1e-14;
  constexpr int kSize = Model::kSize;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  const auto evaluate = [&](const Vector<kSize>& at, Matrix& normal, Vector<kSize>& gradient) {
    const Model model(at, rest...);
    if (!model.usable()) return std::numeric_limits<double>::infinity();
    normal.setZero();
    gradient.setZero();
    double squares = 0.0;
    Vector<kSize> derivatives;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PlanePoint& point = points[i];
      const double error = point.range - model.at(Eigen::Vector2d(point.x, point.y) / point.range, i, derivatives);
      normal += derivatives * derivatives.transpose();
      gradient += derivatives * error;
      squares += error * error;
    }
    return squares;
  };
  Matrix normal, next_normal;
  Vector<kSize> gradient, next_gradient;
  double squares = evaluate(p, normal, gradient);
  if (!std::isfinite(squares)) return std::nullopt;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::LDLT<Matrix> factors(normal);
    if (!factors.isPositive() || factors.rcond() < kSingular) return std::nullopt;
    Vector<kSize> change = factors.solve(gradient);
    double next = std::numeric_limits<double>::infinity();
    for (int halving = 0; halving < kMostHalvings; ++halving, change *= 0.5) {
      next = evaluate(p + change, next_normal, next_gradient);
      if (next <= squares) break;
    }
    if (!(next <= squares)) break;
    p += change;
    squares = next;
    normal = next_normal;
    gradient = next_gradient;
    if (change.squaredNorm() < kSmallestStep2) break;
  }
  const Eigen::LDLT<Matrix> factors(normal);
  if (!factors.isPositive() || factors.rcond() < kSingular) return std::nullopt;
  covariance = factors.solve(Matrix::Identity());
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  return squares;
}

}  // namespace ttf::sensors::laser
