// The turn moments are c_k(u) = int_0^1 t^k cos(u t) dt and s_k(u) = int_0^1 t^k sin(u t) dt, k = 0, 1, 2. With
// u = turn rate times duration, they make up the motion along a bend and its derivatives.
//
// By parts, c_k = (sin u - k s_(k-1)) / u and s_k = (k c_(k-1) - cos u) / u for k > 0, c_0 = sin u / u, s_0 =
// (1 - cos u) / u. These forms cancel for small u, so |u| < 1 uses the power series
//   c_k = sum (-1)^j u^(2j) / ((2j)! (2j + k + 1)),   s_k = u sum (-1)^j u^(2j) / ((2j + 1)! (2j + k + 2)).
// Horner's rule sums ten terms; the eleventh is below 1e-19. Both forms agree to a few 1e-16 at |u| = 1.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "fusion/motion/kernels.h"

namespace ttf::fusion::motion {

struct TurnMoments {
  std::array<double, 3> c, s;
};

inline constexpr std::size_t kTurnTerms = 10;

// Coefficients of (u^2)^j; the three moments lie side by side.
struct TurnSeries {
  std::array<std::array<double, 3>, kTurnTerms> c, s;
};
constexpr TurnSeries turn_series() {
  TurnSeries series{};
  double even = 1.0, odd = 1.0;  // (-1)^j / (2j)! and / (2j + 1)!
  for (std::size_t j = 0; j < kTurnTerms; ++j) {
    const double twice = 2.0 * static_cast<double>(j);
    for (std::size_t k = 0; k < 3; ++k) {
      series.c[j][k] = even / (twice + static_cast<double>(k) + 1.0);
      series.s[j][k] = odd / (twice + static_cast<double>(k) + 2.0);
    }
    even /= -(twice + 1.0) * (twice + 2.0);
    odd /= -(twice + 2.0) * (twice + 3.0);
  }
  return series;
}

[[gnu::flatten]] inline TurnMoments turn_moments(double u) {
  TurnMoments m{};
  if (std::abs(u) < 1.0) {
    constexpr TurnSeries kSeries = turn_series();
    const double squared = u * u;
    unrolled<static_cast<int>(kTurnTerms)>([&](auto back) {
      constexpr std::size_t j = kTurnTerms - 1 - back;
      unrolled<3>([&](auto k) {
        m.c[k] = m.c[k] * squared + kSeries.c[j][k];
        m.s[k] = m.s[k] * squared + kSeries.s[j][k];
      });
    });
    for (double& s : m.s) s *= u;
    return m;
  }
  const double sin = std::sin(u), cos = std::cos(u);
  m.c[0] = sin / u;
  m.s[0] = (1.0 - cos) / u;
  for (std::size_t k = 1; k < 3; ++k) {
    m.c[k] = (sin - static_cast<double>(k) * m.s[k - 1]) / u;
    m.s[k] = (static_cast<double>(k) * m.c[k - 1] - cos) / u;
  }
  return m;
}

}  // namespace ttf::fusion::motion
