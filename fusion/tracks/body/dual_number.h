// A number with its derivatives by length, width and heading of a box: automatic differentiation in forward mode
// (Griewank, Walther: Evaluating Derivatives, 2nd edition, SIAM 2008, 3.1). Every function applies the chain rule to one
// operation. The derivatives fill a vector register; the fourth one is zero. Nothing allocates, unlike atan2 of Eigen's
// AutoDiffScalar.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ttf::fusion::tracks::body {

struct DualNumber {
  using Derivatives = Eigen::Array4d;

  double value = 0.0;
  Derivatives by = Derivatives::Zero();  // by length, width and heading, in this order

  DualNumber() = default;
  explicit DualNumber(double constant) : value(constant) {}
  DualNumber(double at, const Derivatives& derivatives) : value(at), by(derivatives) {}
  // Returns the variable itself: derivative 1 by the k-th of length, width and heading.
  static DualNumber variable(double at, Eigen::Index k) {
    DualNumber x(at);
    x.by(k) = 1.0;
    return x;
  }
};

inline DualNumber operator-(const DualNumber& a) { return {-a.value, -a.by}; }
inline DualNumber operator+(const DualNumber& a, const DualNumber& b) { return {a.value + b.value, a.by + b.by}; }
inline DualNumber operator-(const DualNumber& a, const DualNumber& b) { return {a.value - b.value, a.by - b.by}; }
inline DualNumber operator*(double k, const DualNumber& a) { return {k * a.value, k * a.by}; }
inline DualNumber operator*(const DualNumber& a, const DualNumber& b) {
  return {a.value * b.value, a.by * b.value + b.by * a.value};
}
inline DualNumber operator/(const DualNumber& a, const DualNumber& b) {
  return {a.value / b.value, (a.by * b.value - b.by * a.value) * (1.0 / (b.value * b.value))};
}
inline DualNumber square(const DualNumber& a) { return a * a; }
inline DualNumber sqrt(const DualNumber& a) {
  const double root = std::sqrt(a.value);
  return {root, a.by * (0.5 / root)};
}
inline DualNumber log(const DualNumber& a) { return {std::log(a.value), a.by * (1.0 / a.value)}; }
inline DualNumber atan2(const DualNumber& y, const DualNumber& x) {
  return {std::atan2(y.value, x.value), (y.by * x.value - y.value * x.by) / (y.value * y.value + x.value * x.value)};
}

struct SineAndCosine {
  DualNumber sine, cosine;
};
inline SineAndCosine sine_and_cosine(const DualNumber& angle) {
  const double s = std::sin(angle.value), c = std::cos(angle.value);
  return {{s, angle.by * c}, {c, angle.by * -s}};
}

}  // namespace ttf::fusion::tracks::body
