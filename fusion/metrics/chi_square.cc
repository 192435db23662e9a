#include "fusion/metrics/chi_square.h"

#include <cmath>
#include <limits>

#include "core/check.h"

namespace ttf::fusion::metrics {
namespace {

constexpr double kTiny = std::numeric_limits<double>::min() * 1e10;
constexpr double kPrecision = 1e-15;
constexpr int kMostTerms = 100'000;

// std::lgamma writes a sign that all threads share.
double log_gamma(double a) {
  int sign = 0;
  return ::lgamma_r(a, &sign);
}

double series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < kMostTerms && std::abs(term) > std::abs(sum) * kPrecision; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(-x + a * std::log(x) - log_gamma(a));
}

// Computes the upper function by Lentz's method.
double continued_fraction(double a, double x) {
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, h = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    h *= d * c;
    if (std::abs(d * c - 1.0) < kPrecision) break;
  }
  return h * std::exp(-x + a * std::log(x) - log_gamma(a));
}

}  // namespace

double regularised_gamma(double a, double x) {
  TTF_CHECK(a > 0.0 && x >= 0.0, "a {} x {}", a, x);
  if (x == 0.0) return 0.0;
  return x < a + 1.0 ? series(a, x) : 1.0 - continued_fraction(a, x);
}

double chi_square_quantile(double probability, double degrees) {
  TTF_CHECK(probability > 0.0 && probability < 1.0 && degrees > 0.0, "p {} of {}", probability, degrees);
  double low = 0.0, high = degrees + 10.0 * std::sqrt(2.0 * degrees) + 100.0;
  for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (regularised_gamma(0.5 * degrees, 0.5 * middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace ttf::fusion::metrics
