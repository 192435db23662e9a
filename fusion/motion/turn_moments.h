// c_k(u) = int_0^1 t^k cos(u t) dt and s_k(u) = int_0^1 t^k sin(u t) dt, k = 0, 1, 2: all that a drive along a bend,
// with u = turn rate times duration, and its derivatives are made of.
//
// By parts, c_k = (sin u - k s_(k-1)) / u and s_k = (k c_(k-1) - cos u) / u for k > 0, c_0 = sin u / u, s_0 = (1 - cos
// u) / u. That cancels for small u, so |u| < 1 takes the power series c_k = sum (-1)^j u^(2j) / ((2j)! (2j + k + 1)),
// whose eleventh term is below 1e-19. Both agree to a few 1e-16 where they meet.
#pragma once

#include <array>
#include <cmath>

namespace ttf::fusion::motion {

struct TurnMoments {
  std::array<double, 3> c, s;
};

inline TurnMoments turn_moments(double u) {
  TurnMoments m{};
  if (std::abs(u) < 1.0) {
    double even = 1.0, odd = u;   // (-1)^j u^(2j) / (2j)!, and with 2j + 1
    for (int j = 0; j < 10; ++j) {
      for (int k = 0; k < 3; ++k) {
        m.c[static_cast<std::size_t>(k)] += even / (2 * j + k + 1);
        m.s[static_cast<std::size_t>(k)] += odd / (2 * j + k + 2);
      }
      even *= -u * u / ((2 * j + 1) * (2 * j + 2));
      odd *= -u * u / ((2 * j + 2) * (2 * j + 3));
    }
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
