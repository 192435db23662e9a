// Constant velocity with any covariance: state (x, y, vx, vy), the upper triangle of P column by column.
//
// The operations are those of filters::Kalman with motion::ConstantVelocity and sensors::Position, in their
// order, on the kept elements. So every number equals that filter's bit for bit.
#pragma once

#include "fusion/batch/step.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::batch {

template <class V> struct Joint {
  V x[4] = {};
  V p[10] = {};  // (0,0) (0,1) (1,1) (0,2) (1,2) (2,2) (0,3) (1,3) (2,3) (3,3)

  // Returns the place of row r and column c, r <= c.
  static constexpr int at(int r, int c) { return c * (c + 1) / 2 + r; }
};

template <class V> [[gnu::always_inline]] inline void predict(Joint<V>& state, const Step& step) {
  const auto p = [&state](int r, int c) -> V& { return state.p[Joint<V>::at(r, c)]; };
  const double dt = step.dt;
  state.x[0] += dt * state.x[2];
  state.x[1] += dt * state.x[3];
  // Computes the right half of F P by rows, then the columns.
  const V p02 = p(0, 2) + dt * p(2, 2), p03 = p(0, 3) + dt * p(2, 3);
  const V p12 = p(1, 2) + dt * p(2, 3), p13 = p(1, 3) + dt * p(3, 3);
  p(0, 0) = (p(0, 0) + dt * p(0, 2)) + dt * p02 + step.q_xx;
  p(0, 1) = (p(0, 1) + dt * p(1, 2)) + dt * p03;
  p(1, 1) = (p(1, 1) + dt * p(1, 3)) + dt * p13 + step.q_xx;
  p(0, 2) = p02 + step.q_xv;
  p(0, 3) = p03;
  p(1, 2) = p12;
  p(1, 3) = p13 + step.q_xv;
  p(2, 2) += step.q_vv;
  p(3, 3) += step.q_vv;
}

// Updates in Joseph form, multiplied out (fusion/filters/correct.h). Returns the NIS, valid in seen lanes only.
template <class V> [[gnu::always_inline]] inline V update(Joint<V>& state, const Position<V>& z) {
  const auto p = [&state](int r, int c) { return state.p[r <= c ? Joint<V>::at(r, c) : Joint<V>::at(c, r)]; };
  const V nu_x = z.x - state.x[0], nu_y = z.y - state.x[1];
  // S = L D L'.
  const V d_x = p(0, 0) + z.r_xx;
  const V inverse_x = 1.0 / d_x;
  const V l = (p(1, 0) + z.r_xy) * inverse_x;
  const V inverse_y = 1.0 / ((p(1, 1) + z.r_yy) - l * l * d_x);
  V g_x[4], g_y[4];  // K
  motion::unrolled<4>([&](int i) {
    g_y[i] = (p(i, 1) - l * p(i, 0)) * inverse_y;
    g_x[i] = p(i, 0) * inverse_x - l * g_y[i];
  });
  // T = P - K W in rows and columns 0 and 1 and in the upper triangle, E = T H' - K R.
  const auto t = [&](int r, int c) { return p(r, c) - (g_x[r] * p(c, 0) + g_y[r] * p(c, 1)); };
  V e_x[4], e_y[4];
  motion::unrolled<4>([&](int i) {
    e_x[i] = t(i, 0) - (g_x[i] * z.r_xx + g_y[i] * z.r_xy);
    e_y[i] = t(i, 1) - (g_x[i] * z.r_xy + g_y[i] * z.r_yy);
  });
  V updated[10];
  motion::unrolled<4>([&](auto column) {
    constexpr int c = column;
    motion::unrolled<c + 1>(
        [&](int r) { updated[Joint<V>::at(r, c)] = t(r, c) - (e_x[r] * g_x[c] + e_y[r] * g_y[c]); });
  });
  motion::unrolled<4>(
      [&](int i) { state.x[i] = select(z.seen, state.x[i] + (g_x[i] * nu_x + g_y[i] * nu_y), state.x[i]); });
  motion::unrolled<10>([&](int i) { state.p[i] = select(z.seen, updated[i], state.p[i]); });
  const V white_y = nu_y - l * nu_x;
  return nu_x * nu_x * inverse_x + white_y * white_y * inverse_y;
}

}  // namespace ttf::fusion::batch
